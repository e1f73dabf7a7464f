// SPDX-License-Identifier: BSD-3-Clause
#include "tools/csv.hpp"

#include "tests/tools/temporary_file.hpp"

#include <gtest/gtest.h>

#include <stdexcept>

namespace lilo {
namespace {

TEST(Csv, QuotesWhatRfc4180Quotes) {
  EXPECT_EQ(csv_line({"a", "b c", ""}), "a,b c,\n");
  EXPECT_EQ(csv_line({"1,5", "say \"hi\""}), "\"1,5\",\"say \"\"hi\"\"\"\n");
  EXPECT_EQ(csv_fields("\"1,5\",\"say \"\"hi\"\"\",,x"),
            (std::vector<std::string>{"1,5", "say \"hi\"", "", "x"}));
}

TEST(Csv, WhatIsWrittenIsRead) {
  const TemporaryFile file;
  const CsvTable table{{"set", "value"}, {{"park, north", "1.5"}, {"town", ""}}};
  write_csv(file.path(), table);
  const CsvTable read = read_csv(file.path());
  EXPECT_EQ(read.columns, table.columns);
  EXPECT_EQ(read.rows, table.rows);
  EXPECT_EQ(read.column("value"), 1U);
  EXPECT_THROW((void)read.column("error"), std::runtime_error);
}

TEST(Csv, ALineThatWasCutOffIsLeftOut) {
  const TemporaryFile file("a,b\n1,2\n3,");
  EXPECT_EQ(read_csv(file.path()).rows, (std::vector<std::vector<std::string>>{{"1", "2"}}));
}

TEST(Csv, ARowOfAnotherLengthIsNamed) {
  const TemporaryFile file("a,b\n1,2\n3\n4,5\n");
  try {
    (void)read_csv(file.path());
    FAIL();
  } catch (const std::runtime_error& error) {
    EXPECT_EQ(error.what(), file.path() + ":3: expected 2 fields, found 1");
  }
}

}  // namespace
}  // namespace lilo
