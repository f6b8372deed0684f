#include <fmt/format.h>

#include <string>

#include "engine/draw/markup.hpp"
#include "engine/report/report.hpp"
#include "engine/report/report_tables.hpp"
#include "engine/study/table.hpp"

namespace sluice {
namespace {

/// Lines of at most 100 columns, broken at blanks.
std::string wrapped(const std::string& line) {
  constexpr std::size_t kColumns = 100;
  std::string text;
  std::size_t from = 0;
  while (line.size() - from > kColumns) {
    const std::size_t blank = line.rfind(' ', from + kColumns);
    if (blank == std::string::npos || blank <= from) break;
    text += line.substr(from, blank - from) + "\n";
    from = blank + 1;
  }
  return text + line.substr(from) + "\n";
}

}  // namespace

std::string report_text(const Report& report) {
  std::string text = printable(report.scene.name) + "\n";
  for (const std::string& line : report_lines(report)) text += wrapped(printable(line));
  text += "\n";
  for (const Table& table : report_tables(report)) {
    Table shown = table;
    if (!shown.note.empty()) {
      shown.note = wrapped(printable(shown.note));
      shown.note.pop_back();
    }
    text += table_text(shown);
  }
  return text;
}

std::string report_markdown(const Report& report) {
  std::string text = fmt::format("# {}\n\n", markdown_escaped(report.scene.name));
  for (const std::string& line : report_lines(report)) {
    text += markdown_escaped(line) + "\n\n";
  }
  for (const Table& table : report_tables(report)) text += table_markdown(table);
  return text;
}

}  // namespace sluice
