#include "service/jobs/job_ids.hpp"

#include <fmt/format.h>
#include <sys/random.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <system_error>

namespace sluice {
namespace {

constexpr std::string_view kDigits = "0123456789abcdefghijklmnopqrstuv";
constexpr std::size_t kHalf = 10;  // characters, 5 bits each
constexpr std::uint64_t kHalfMask = (std::uint64_t{1} << (5 * kHalf)) - 1;

std::uint64_t random_bits() {
  std::uint64_t bits = 0;
  // The system gives up to 256 bytes whole, once it has any to give.
  while (::getrandom(&bits, sizeof bits, 0) != static_cast<ssize_t>(sizeof bits)) {
    if (errno != EINTR) {
      throw std::system_error(errno, std::generic_category(), "no random numbers to be had");
    }
  }
  return bits;
}

std::string write_half(std::uint64_t value) {
  std::string text(kHalf, '0');
  for (std::size_t i = kHalf; i-- > 0; value >>= 5U) text[i] = kDigits[value & 31U];
  return text;
}

std::uint64_t read_half(std::string_view text) {
  std::uint64_t value = 0;
  for (const char digit : text) value = (value << 5U) | kDigits.find(digit);
  return value;
}

}  // namespace

std::string JobIds::next(std::int64_t now_ms) {
  const std::uint64_t now = static_cast<std::uint64_t>(std::max<std::int64_t>(now_ms, 0));
  if ((now & kHalfMask) > time_) {
    time_ = now & kHalfMask;
    tail_ = random_bits() & kHalfMask;
  } else {
    // A random step, so that two programs with the same past do not make the same ids.
    tail_ += 1 + (random_bits() & 0xffffffU);
    time_ += tail_ >> (5 * kHalf);
    tail_ &= kHalfMask;
  }
  return "j" + write_half(time_) + write_half(tail_);
}

void JobIds::follow(std::string_view id) {
  if (!is_job_id(id)) return;
  const std::uint64_t time = read_half(id.substr(1, kHalf));
  const std::uint64_t tail = read_half(id.substr(1 + kHalf));
  if (time > time_ || (time == time_ && tail > tail_)) {
    time_ = time;
    tail_ = tail;
  }
}

bool is_job_id(std::string_view text) {
  return text.size() == 1 + 2 * kHalf && text.front() == 'j' &&
         text.find_first_not_of(kDigits, 1) == std::string_view::npos;
}

bool is_study_id(std::string_view text) {
  return text.starts_with('s') && is_job_id(fmt::format("j{}", text.substr(1)));
}

std::string study_id_of(std::string_view job_id) { return fmt::format("s{}", job_id.substr(1)); }

std::optional<std::int64_t> time_of_job_id(std::string_view id) {
  if (!is_job_id(id)) return std::nullopt;
  return static_cast<std::int64_t>(read_half(id.substr(1, kHalf)));
}

std::string random_token() { return fmt::format("{:016x}{:016x}", random_bits(), random_bits()); }

std::int64_t unix_time_ms() {
  return std::chrono::duration_cast<std::chrono::milliseconds>(
             std::chrono::system_clock::now().time_since_epoch())
      .count();
}

}  // namespace sluice
