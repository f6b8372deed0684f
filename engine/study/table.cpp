#include "engine/study/table.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cmath>

#include "engine/draw/markup.hpp"
#include "engine/scene/format/code_points.hpp"

namespace sluice {
namespace {

constexpr std::string_view kNone = "-";

/// Columns that a terminal shows for a UTF-8 text of plain letters.
std::size_t width_of(std::string_view text) { return count_code_points(text); }

bool looks_numeric(std::string_view cell) {
  if (cell.empty() || cell == kNone) return true;
  const char first = cell.front();
  const bool sign = (first == '-' || first == '+' || first == '.') && cell.size() > 1;
  const char digit = sign ? cell[1] : first;
  return std::isdigit(static_cast<unsigned char>(digit)) != 0;
}

/// A column is set to the right when all its cells are numbers; the first one names rows.
std::vector<bool> right_columns(const Table& table) {
  std::vector<bool> right(table.head.size(), true);
  if (!right.empty()) right[0] = false;
  for (const auto& row : table.rows) {
    for (std::size_t k = 1; k < row.size(); ++k) right[k] = right[k] && looks_numeric(row[k]);
  }
  return right;
}

std::string aligned(const std::vector<std::string>& row, const std::vector<std::size_t>& widths,
                    const std::vector<bool>& right) {
  std::string line;
  for (std::size_t k = 0; k < row.size(); ++k) {
    const std::string blanks(widths[k] - width_of(row[k]), ' ');
    if (k > 0) line += "  ";
    line += right[k] ? blanks + row[k] : row[k] + blanks;
  }
  line.erase(line.find_last_not_of(' ') + 1);
  return line + "\n";
}

/// The table as a terminal may see it: names and reasons come from whoever wrote the scene.
Table printable_table(Table table) {
  table.title = printable(table.title);
  for (std::string& text : table.head) text = printable(text);
  for (auto& row : table.rows) {
    for (std::string& text : row) text = printable(text);
  }
  return table;
}

std::string markdown_row(const std::vector<std::string>& row) {
  std::string line = "|";
  for (const std::string& text : row) line += fmt::format(" {} |", markdown_escaped(text));
  return line + "\n";
}

bool is_number(std::string_view text) {
  double value = 0.0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  return error == std::errc{} && end == text.data() + text.size();
}

/// Spreadsheets compute a cell that begins like this, quoted or not.
bool looks_like_formula(std::string_view text) {
  constexpr std::string_view kFirst = "=+-@\t\r";
  return !text.empty() && kFirst.find(text.front()) != kFirst.npos && !is_number(text);
}

std::string csv_cell(const std::string& text) { return text == kNone ? "" : csv_field(text); }

std::string csv_row(const std::vector<std::string>& row) {
  std::string line;
  for (std::size_t k = 0; k < row.size(); ++k) line += (k > 0 ? "," : "") + csv_cell(row[k]);
  return line + "\n";
}

}  // namespace

std::string cell(const std::optional<double>& value, int decimals) {
  return value && std::isfinite(*value) ? fmt::format("{:.{}f}", *value, decimals)
                                        : std::string(kNone);
}

std::string brief(const std::optional<double>& value, int digits) {
  return value && std::isfinite(*value) ? fmt::format("{:.{}g}", *value, digits)
                                        : std::string(kNone);
}

std::string markdown_escaped(std::string_view text) {
  std::string result;
  for (const char letter : printable(text)) {
    if (letter == '|' || letter == '\\' || letter == '`' || letter == '*' || letter == '_' ||
        letter == '<' || letter == '[') {
      result += '\\';
    }
    result += letter;
  }
  return result;
}

std::string table_text(const Table& of_any_text) {
  const Table table = printable_table(of_any_text);
  std::vector<std::size_t> widths;
  for (const std::string& text : table.head) widths.push_back(width_of(text));
  for (const auto& row : table.rows) {
    for (std::size_t k = 0; k < row.size(); ++k) widths[k] = std::max(widths[k], width_of(row[k]));
  }
  const std::vector<bool> right = right_columns(table);
  std::string text = table.title + "\n";
  if (!table.note.empty()) text += table.note + "\n";
  text += aligned(table.head, widths, right);
  for (const auto& row : table.rows) text += aligned(row, widths, right);
  return text + "\n";
}

std::string table_markdown(const Table& table) {
  std::string text = fmt::format("## {}\n\n", printable(table.title));
  if (!table.note.empty()) text += markdown_escaped(table.note) + "\n\n";
  text += markdown_row(table.head) + "|";
  for (const bool right : right_columns(table)) text += right ? "---:|" : "---|";
  text += "\n";
  for (const auto& row : table.rows) text += markdown_row(row);
  return text + "\n";
}

std::string table_html(const Table& table) {
  std::string text = fmt::format("<h2>{}</h2>\n", escaped(table.title));
  if (!table.note.empty()) text += fmt::format("<p class=\"note\">{}</p>\n", escaped(table.note));
  text += "<div class=\"scroll\"><table>\n<thead><tr>";
  const std::vector<bool> right = right_columns(table);
  for (std::size_t k = 0; k < table.head.size(); ++k) {
    text += fmt::format("<th scope=\"col\"{}>{}</th>", right[k] ? " class=\"n\"" : "",
                        escaped(table.head[k]));
  }
  text += "</tr></thead>\n<tbody>\n";
  for (const auto& row : table.rows) {
    text += "<tr>";
    for (std::size_t k = 0; k < row.size(); ++k) {
      text += k == 0
                  ? fmt::format("<th scope=\"row\">{}</th>", escaped(row[k]))
                  : fmt::format("<td{}>{}</td>", right[k] ? " class=\"n\"" : "", escaped(row[k]));
    }
    text += "</tr>\n";
  }
  return text + "</tbody></table></div>\n";
}

std::string csv_field(std::string_view text) {
  const bool formula = looks_like_formula(text);
  if (!formula && text.find_first_of("\",;\t\n\r") == text.npos) return std::string(text);
  std::string quoted = formula ? "\"'" : "\"";
  for (const char letter : text) {
    quoted += letter;
    if (letter == '"') quoted += '"';
  }
  return quoted + "\"";
}

std::string table_csv(const Table& table) {
  std::string text = csv_row(table.head);
  for (const auto& row : table.rows) text += csv_row(row);
  return text;
}

}  // namespace sluice
