#include "engine/study/table.hpp"

#include <gtest/gtest.h>

namespace sluice {
namespace {

Table small() {
  Table table;
  table.title = "Small";
  table.head = {"name", "value"};
  table.rows = {{"a", "1.5"}, {"long, \"b\"", "-"}, {"c", "22.25"}};
  return table;
}

TEST(Table, CsvGivesASpreadsheetNothingToCompute) {
  for (const char* const text :
       {"=cmd|' /C calc'!A0", "+1+1", "-2+3", "@SUM(A1)", "\t=1", "\r=1"}) {
    EXPECT_EQ(csv_field(text), "\"'" + std::string(text) + "\"");
  }
  EXPECT_EQ(csv_field("=\"a\""), "\"'=\"\"a\"\"\"");
  for (const char* const text : {"-1.5", "-3e-05", "a=b", "x", ""})
    EXPECT_EQ(csv_field(text), text);
  EXPECT_EQ(csv_field("a;=1"), "\"a;=1\"") << "a semicolon parts cells, too";
}

TEST(Table, SetsNumbersToTheRightAndNamesToTheLeft) {
  EXPECT_EQ(table_text(small()),
            "Small\nname       value\na            1.5\nlong, \"b\"      -\nc          22.25\n\n");
}

TEST(Table, CountsLettersAndNotBytes) {
  Table table = small();
  table.rows = {{"ü√", "1"}, {"abc", "2"}};
  EXPECT_NE(table_text(table).find("ü√        1\nabc       2\n"), std::string::npos);
}

TEST(Table, QuotesCsvAsItsStandardSays) {
  EXPECT_EQ(table_csv(small()), "name,value\na,1.5\n\"long, \"\"b\"\"\",\nc,22.25\n");
}

TEST(Table, IsMarkdownWithNumbersToTheRight) {
  EXPECT_NE(table_markdown(small()).find("| name | value |\n|---|---:|\n| a | 1.5 |\n"),
            std::string::npos);
}

TEST(Table, ShowsNoNumberForWhatIsNone) {
  EXPECT_EQ(cell(std::nullopt), "-");
  EXPECT_EQ(cell(0.12345, 3), "0.123");
  EXPECT_EQ(brief(1.0 / 0.0), "-");
}

}  // namespace
}  // namespace sluice
