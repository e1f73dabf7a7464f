// SPDX-License-Identifier: BSD-3-Clause
#include "tools/bench/worlds/worlds_report.hpp"

#include "tools/bench/worlds/comparison.hpp"
#include "tools/bench/worlds/world_rows.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <iterator>

namespace lilo::worlds {
namespace {

/// Cells of text, every line as long as the heading.
using Table = std::vector<std::vector<std::string>>;

/// The first two columns to the left, numbers to the right.
std::string aligned(const Table& table) {
  std::vector<std::size_t> widths(table.front().size(), 0);
  for (const auto& line : table) {
    for (std::size_t k = 0; k < line.size(); ++k) widths[k] = std::max(widths[k], line[k].size());
  }
  std::string text;
  for (const auto& line : table) {
    for (std::size_t k = 0; k < line.size(); ++k) {
      text += k < 2 ? fmt::format("{:<{}}  ", line[k], widths[k])
                    : fmt::format("{:>{}}  ", line[k], widths[k]);
    }
    text.erase(text.find_last_not_of(' ') + 1);
    text += '\n';
  }
  return text;
}

Table headed() {
  Table table{{"world", "seeds"}};
  for (const Column& column : columns()) table[0].emplace_back(column.heading);
  return table;
}

std::string mean_text(const Spread& spread, const Column& column) {
  if (spread.count == 0) return "-";
  std::string mean = fmt::format("{:.{}f}", spread.mean, column.decimals);
  if (!column.spread || spread.count == 1) return mean;
  return fmt::format("{}+-{:.{}f}", mean, spread.deviation, column.decimals);
}

std::string variant_text(const std::vector<Row>& rows, std::size_t variant) {
  Table table = headed();
  for (const Row& row : rows) {
    if (row.seeds.empty()) continue;
    table.push_back({row.world, seeds_text(row.role, row.seeds)});
    for (const Column& column : columns()) {
      table.back().push_back(mean_text(spread_of(values(row, variant, column)), column));
    }
  }
  return aligned(table);
}

Difference difference(const Row& row, const Column& column) {
  return difference_of(values(row, 0, column), values(row, 1, column));
}

std::string difference_text(const Difference& difference, const Column& column) {
  if (difference.count == 0) return "-";
  if (difference.mean == 0.0 && difference.standard_error == 0.0) return "=";
  std::string mean = fmt::format("{:+.{}f}", difference.mean, column.decimals);
  if (difference.count == 1) return mean;
  return fmt::format("{}+-{:.{}f}{}", mean, difference.standard_error, column.decimals,
                     difference.beyond_spread ? "*" : " ");
}

/// "t %: lower in v_park; higher in v_jam".
std::string verdict(const std::vector<Row>& rows, const Column& column) {
  std::vector<std::string> lower, higher;
  for (const Row& row : rows) {
    const Difference d = difference(row, column);
    if (!d.beyond_spread) continue;
    (d.mean < 0.0 ? lower : higher)
        .push_back(fmt::format("{} ({})", row.world, to_string(row.role)));
  }
  if (lower.empty() && higher.empty()) return {};
  std::string text = fmt::format("  {}:", column.heading);
  if (!lower.empty()) text += fmt::format(" lower in {}", fmt::join(lower, ", "));
  if (!lower.empty() && !higher.empty()) text += ";";
  if (!higher.empty()) text += fmt::format(" higher in {}", fmt::join(higher, ", "));
  return text + "\n";
}

std::string differences_text(const std::vector<Row>& rows) {
  std::string text =
      "\nsecond minus first, mean over the same seeds +- its standard error; * is beyond the "
      "spread:\n"
      "more than two standard errors. Without +- it is of one seed; = is the same in all.\n";
  Table table = headed();
  for (const Row& row : rows) {
    if (row.seeds.empty()) continue;
    table.push_back({row.world, seeds_text(row.role, row.seeds)});
    for (const Column& column : columns()) {
      table.back().push_back(difference_text(difference(row, column), column));
    }
  }
  text += aligned(table);
  std::string verdicts;
  for (const Column& column : columns()) verdicts += verdict(rows, column);
  return text +
         (verdicts.empty() ? "nothing is beyond the spread\n" : "beyond the spread\n" + verdicts);
}

std::string troubles_text(const std::vector<Row>& rows) {
  std::string text;
  for (const Row& row : rows) {
    for (const Outcome* outcome : row.without) {
      text += fmt::format("{} {}: {}\n", outcome->skipped ? "skipped" : "failed",
                          label(outcome->drive), outcome->trouble);
    }
  }
  return text;
}

}  // namespace

std::string to_text(const std::vector<Outcome>& outcomes) {
  const std::vector<Row> rows = rows_of(outcomes);
  const auto good = std::find_if(outcomes.begin(), outcomes.end(),
                                 [](const Outcome& o) { return !o.figures.empty(); });
  const bool compared = good != outcomes.end() && good->figures.size() == 2;
  std::string text;
  if (compared) text += "first\n";
  if (good != outcomes.end()) text += variant_text(rows, 0);
  if (compared) text += "\nsecond\n" + variant_text(rows, 1) + differences_text(rows);
  return text + troubles_text(rows);
}

}  // namespace lilo::worlds
