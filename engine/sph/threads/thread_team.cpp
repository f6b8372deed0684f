#include "engine/sph/threads/thread_team.hpp"

#include <hwy/cache_control.h>

#include <utility>

#include "engine/sph/threads/new_thread.hpp"

namespace sluice {
namespace {

// Some 200 microseconds: longer than the serial part between two passes and than the last chunk of
// another thread, for waking a sleeper costs as much; shorter than a scheduler's time slice.
constexpr int kSpins = 5000;

/// Waits until `word` is no longer `old`: spins first, then sleeps.
void wait_while(const std::atomic<std::uint64_t>& word, std::uint64_t old) {
  for (int i = 0; i < kSpins; ++i) {
    if (word.load(std::memory_order_acquire) != old) return;
    hwy::Pause();
  }
  word.wait(old, std::memory_order_acquire);
}

}  // namespace

ThreadTeam::ThreadTeam(int threads) {
  const auto helpers = static_cast<std::size_t>(threads > 1 ? threads - 1 : 0);
  shares_ = std::make_unique<Share[]>(2 * (helpers + 1));
  helpers_.reserve(helpers);
  try {
    for (std::size_t i = 0; i < helpers; ++i) {
      helpers_.push_back(new_thread([this, i] { help(i + 1); }));
    }
  } catch (...) {
    end_helpers();
    throw;
  }
}

ThreadTeam::~ThreadTeam() { end_helpers(); }

void ThreadTeam::end_helpers() {
  stop_.store(true, std::memory_order_relaxed);
  state_.fetch_add(kEpoch, std::memory_order_release);
  state_.notify_all();
  for (std::thread& helper : helpers_) helper.join();
}

void ThreadTeam::run_shared(std::size_t rounds, std::size_t tasks, Call call, const void* body) {
  const std::size_t members = helpers_.size() + 1;
  for (std::size_t n = 0; n < rounds * members; ++n) {
    const std::size_t before = n / members * tasks;
    const std::size_t i = n % members;
    shares_[n].next.store(before + tasks * i / members, std::memory_order_relaxed);
    shares_[n].begin = shares_[n].next.load(std::memory_order_relaxed);
    shares_[n].end = before + tasks * (i + 1) / members;
  }
  rounds_ = rounds;
  call_ = call;
  body_ = body;
  const std::uint64_t epoch = state_.load(std::memory_order_relaxed) + kEpoch;
  state_.store(epoch | kOpen, std::memory_order_release);
  state_.notify_all();

  work(0);

  // Whoever has not joined by now finds the door closed; whoever has is waited for.
  std::uint64_t now = state_.fetch_and(~kOpen, std::memory_order_acq_rel) & ~kOpen;
  while ((now & kAtWork) != 0) {
    wait_while(state_, now);
    now = state_.load(std::memory_order_acquire);
  }
  if (failure_) std::rethrow_exception(std::exchange(failure_, nullptr));
}

void ThreadTeam::keep_failure(std::exception_ptr failure) {
  const std::scoped_lock one(failing_);
  failure_ = std::move(failure);
}

void ThreadTeam::work(std::size_t self) {
  const std::size_t members = helpers_.size() + 1;
  for (std::size_t n = 0; n < rounds_ * members; ++n) {
    Share& share = shares_[n / members * members + (self + n) % members];
    for (;;) {
      const std::size_t task = share.next.fetch_add(1, std::memory_order_relaxed);
      if (task >= share.end) break;
      try {
        call_(body_, n < members ? task : share.rotated(task));
      } catch (...) {
        keep_failure(std::current_exception());
      }
    }
  }
}

void ThreadTeam::help(std::size_t self) {
  std::uint64_t seen = 0;
  for (;;) {
    std::uint64_t now = state_.load(std::memory_order_acquire);
    if (stop_.load(std::memory_order_relaxed)) return;
    const bool joinable = (now & kOpen) != 0 && now / kEpoch != seen;
    if (!joinable) {
      wait_while(state_, now);
    } else if (state_.compare_exchange_weak(now, now + 1, std::memory_order_acq_rel)) {
      seen = now / kEpoch;
      work(self);
      state_.fetch_sub(1, std::memory_order_acq_rel);
      state_.notify_all();
    }
  }
}

void ThreadTeam::reset_firsts(std::size_t tasks) {
  if (tasks > first_count_) {
    first_done_ = std::make_unique<std::atomic<std::uint64_t>[]>(tasks);
    first_count_ = tasks;
  }
  for (std::size_t n = 0; n < tasks; ++n) first_done_[n].store(0, std::memory_order_relaxed);
}

void ThreadTeam::finish_first(std::size_t task) {
  first_done_[task].store(1, std::memory_order_release);
  first_done_[task].notify_all();
}

void ThreadTeam::await_first(std::size_t task) const {
  while (first_done_[task].load(std::memory_order_acquire) == 0) wait_while(first_done_[task], 0);
}

}  // namespace sluice
