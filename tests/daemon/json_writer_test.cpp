// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/json_writer.hpp"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <cmath>
#include <limits>
#include <random>
#include <string>

namespace lilo {
namespace {

using nlohmann::json;

TEST(JsonWriter, WritesWhatAParserReads) {
  JsonWriter out;
  out.text("name", "lilo");
  out.begin_object("a");
  out.integer("min", std::numeric_limits<std::int64_t>::min());
  out.unsigned_integer("max", std::numeric_limits<std::uint64_t>::max());
  out.boolean("yes", true);
  out.begin_array("list");
  out.scientific(1.23456e-7);
  out.item("two");
  out.end_array();
  out.end_object();
  out.number("last", -0.5, 7);
  EXPECT_EQ(out.finish(),
            R"({"name":"lilo","a":{"min":-9223372036854775808,"max":18446744073709551615,)"
            R"("yes":true,"list":[1.235e-07,"two"]},"last":-0.5})");
}

TEST(JsonWriter, EmptyObjectsAndArrays) {
  JsonWriter out;
  out.begin_object("o");
  out.end_object();
  out.begin_array("a");
  out.end_array();
  EXPECT_EQ(out.finish(), R"({"o":{},"a":[]})");
}

TEST(JsonWriter, NumbersThatAreNotFiniteCannotBeWritten) {
  for (const double bad : {std::nan(""), HUGE_VAL, -HUGE_VAL}) {
    JsonWriter out;
    out.number("bad", bad, 6);
    out.begin_array("list");
    out.scientific(bad);
    out.end_array();
    EXPECT_EQ(out.finish(), R"({"list":[null]})");
  }
}

// One half of the last decimal, over sixteen orders of magnitude.
TEST(JsonWriter, KeepsTheDecimalsAskedFor) {
  std::mt19937 rng(1);
  std::uniform_real_distribution<double> exponent(-10.0, 6.0), sign(-1.0, 1.0);
  for (int k = 0; k < 2000; ++k) {
    const double value = std::copysign(std::pow(10.0, exponent(rng)), sign(rng));
    JsonWriter out;
    out.number("x", value, 7);
    const json parsed = json::parse(out.finish());
    EXPECT_NEAR(parsed["x"].get<double>(), value, 0.51e-7);
  }
}

TEST(JsonWriter, SecondsAreExact) {
  const auto written = [](std::int64_t ns) {
    JsonWriter out;
    out.seconds("t", ns);
    return std::string(out.finish());
  };
  EXPECT_EQ(written(1453364282709000001), R"({"t":1453364282.709000001})");
  EXPECT_EQ(written(1453364282000000000), R"({"t":1453364282})");
  EXPECT_EQ(written(5), R"({"t":0.000000005})");
  EXPECT_EQ(written(-1500000000), R"({"t":-1.5})");
  EXPECT_EQ(written(0), R"({"t":0})");
  EXPECT_EQ(written(std::numeric_limits<std::int64_t>::min()), R"({"t":-9223372036.854775808})");
}

TEST(JsonWriter, AnyBytesBecomeAValidString) {
  std::string all;
  for (int byte = 0; byte < 256; ++byte) all += static_cast<char>(byte);
  JsonWriter out;
  out.text("s", all);
  const json parsed = json::parse(out.finish());
  const auto text = parsed["s"].get<std::string>();
  ASSERT_EQ(text.size(), 256U);
  EXPECT_EQ(text.substr(0, 127), all.substr(0, 127));
  EXPECT_EQ(text.substr(127), std::string(129, '?'));
}

// Filled byte by byte over its end: valid up to the last one, nothing beyond.
TEST(JsonWriter, IsWholeOrNothing) {
  for (std::size_t size = JsonWriter::kCapacity - 20; size < JsonWriter::kCapacity + 20; ++size) {
    JsonWriter out;
    out.text("s", std::string(size, 'x'));
    const std::string_view text = out.finish();
    const std::size_t needed = size + std::string_view(R"({"s":""})").size();
    EXPECT_EQ(text.size(), needed <= JsonWriter::kCapacity ? needed : 0) << size;
  }
}

}  // namespace
}  // namespace lilo
