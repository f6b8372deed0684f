#include "engine/scene/format/text_rules.hpp"

#include <algorithm>
#include <string>

namespace sluice {
namespace {

bool is_letter_or_digit(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9');
}
bool is_name_character(char c) { return is_letter_or_digit(c) || c == '_' || c == '.' || c == '-'; }
bool is_control_character(char c) { return (c >= 0 && c < ' ') || c == 0x7f; }
bool is_digit_of_hash(char c) { return (c >= '0' && c <= '9') || (c >= 'a' && c <= 'f'); }

/// A bare name: no folder, hidden file or option can be meant by it.
bool is_mesh_name(std::string_view text) {
  constexpr std::size_t kEnding = 4;
  if (text.size() <= kEnding || !is_letter_or_digit(text.front())) return false;
  if (!std::all_of(text.begin(), text.end(), is_name_character)) return false;
  std::string ending(text.substr(text.size() - kEnding));
  for (char& c : ending) c = c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
  return ending == ".stl" || ending == ".obj";
}

}  // namespace

bool are_allowed(std::string_view text, Characters characters) {
  switch (characters) {
    case Characters::name:
      return std::all_of(text.begin(), text.end(), is_name_character);
    case Characters::sentence:
      return std::none_of(text.begin(), text.end(), is_control_character);
    case Characters::mesh:
      return is_mesh_name(text);
    case Characters::sha256:
      return std::all_of(text.begin(), text.end(), is_digit_of_hash);
  }
  return false;
}

std::string_view allowed_text(Characters characters) {
  switch (characters) {
    case Characters::name:
      return "each a letter, a digit or one of _ . -";
    case Characters::sentence:
      return "none a control character";
    case Characters::mesh:
      return "the name of a file beside the scene without a folder: letters, digits and _ . -, "
             "ending in .stl or .obj";
    case Characters::sha256:
      return "each a digit or one of a to f";
  }
  return {};
}

std::string_view allowed_pattern(Characters characters) {
  switch (characters) {
    case Characters::name:
      return "^[A-Za-z0-9_.-]*$";
    case Characters::sentence:
      return "^[^\\u0000-\\u001f\\u007f]*$";
    case Characters::mesh:
      return "^[A-Za-z0-9][A-Za-z0-9_.-]*\\.([sS][tT][lL]|[oO][bB][jJ])$";
    case Characters::sha256:
      return "^[0-9a-f]*$";
  }
  return {};
}

}  // namespace sluice
