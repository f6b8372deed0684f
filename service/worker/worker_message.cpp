#include "service/worker/worker_message.hpp"

#include <algorithm>
#include <nlohmann/json.hpp>
#include <stdexcept>

#include "engine/scene/format/json_text.hpp"

namespace sluice {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::size_t kLongestName = 40;

std::string text_of(const Json& object, const char* key) {
  const auto found = object.find(key);
  return found != object.end() && found->is_string() ? found->get<std::string>() : std::string();
}

}  // namespace

std::optional<WorkerMessage> parse_worker_line(std::string_view line) {
  Json object;
  try {
    object = read_stored_json(line);
  } catch (const std::runtime_error&) {
    return {};
  }
  if (!object.is_object()) return {};
  WorkerMessage message;
  message.event = text_of(object, "event");
  if (message.event.empty() || message.event.size() > kLongestName) return {};
  const auto step = object.find("step");
  if (step != object.end() && step->is_number_unsigned()) message.step = step->get<std::uint64_t>();
  message.text = text_of(object, "message");
  if (message.text.empty()) message.text = text_of(object, "reason");
  object.erase("event");
  message.detail = object.dump();
  return message;
}

std::string printable(std::string_view text, std::size_t bytes) {
  std::string result(text.substr(0, bytes));
  std::replace_if(
      result.begin(), result.end(), [](char letter) { return letter < ' ' || letter > '~'; }, '?');
  return result;
}

}  // namespace sluice
