#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace sluice {

/// A table of a report, whatever its format. Every row is as long as the head; "-" is a value that
/// there is none of.
struct Table {
  std::string title;
  std::string note;  ///< what a reader must know to read it; may be empty
  std::vector<std::string> head;
  std::vector<std::vector<std::string>> rows;
};

/// A value with `decimals`, or "-".
[[nodiscard]] std::string cell(const std::optional<double>& value, int decimals = 3);
/// The same with `digits` that count, in the shortest form.
[[nodiscard]] std::string brief(const std::optional<double>& value, int digits = 4);

/// Columns aligned with blanks, numbers to the right.
[[nodiscard]] std::string table_text(const Table& table);
/// Text with what Markdown gives a meaning escaped.
[[nodiscard]] std::string markdown_escaped(std::string_view text);
/// A heading and a table of GitHub-flavoured Markdown.
[[nodiscard]] std::string table_markdown(const Table& table);
/// A heading and a <table>; everything escaped.
[[nodiscard]] std::string table_html(const Table& table);
/// A field of RFC 4180. A text that a spreadsheet would compute, which begins with = + - @, a tab
/// or a carriage return and is no number, gets an apostrophe in front.
[[nodiscard]] std::string csv_field(std::string_view text);
/// RFC 4180 with lines that end in a line feed; "-" becomes an empty field.
[[nodiscard]] std::string table_csv(const Table& table);

}  // namespace sluice
