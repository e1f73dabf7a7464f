// SPDX-License-Identifier: BSD-3-Clause
#include "tools/bench/paper/html_report.hpp"

#include "tools/bench/base64.hpp"
#include "tools/text_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>

namespace lilo::paper_bench {
namespace {

constexpr const char* kStyle = R"(
body { font: 15px/1.5 "DejaVu Sans", "Segoe UI", sans-serif; color: #222; max-width: 1240px;
       margin: 2em auto; padding: 0 1.5em; }
h1 { font-size: 1.7em; } h2 { font-size: 1.2em; margin: 2.2em 0 .3em; }
p { margin: .3em 0 .8em; color: #555; }
table { border-collapse: collapse; font-size: .87em; font-variant-numeric: tabular-nums; }
th { text-align: right; border-bottom: 2px solid #444; padding: .25em .7em; vertical-align: bottom; }
td { text-align: right; border-bottom: 1px solid #ddd; padding: .2em .7em; }
.words { text-align: left; }
tr.last td { border-top: 1px solid #444; font-weight: bold; }
td.paper, th.paper { background: #f3f1e8; }
.line { color: #999; font-size: .85em; }
.wide { overflow-x: auto; } img { max-width: 100%; } figure { margin: 2em 0; }
figcaption { color: #555; } figcaption b { color: #222; display: block; font-size: 1.1em; }
@media print { body { max-width: none; margin: 0; } figure, table { break-inside: avoid; } }
)";

std::string file_bytes(const std::string& path) {
  std::ifstream file = open_text(path);
  return {std::istreambuf_iterator<char>(file), {}};
}

/// "t_percent" -> "t %".
std::string heading(std::string column) {
  const auto replace = [&column](const std::string& from, const std::string& to) {
    const std::size_t at = column.find(from);
    if (at != std::string::npos) column.replace(at, from.size(), to);
  };
  replace("paper_", "paper ");
  replace("_percent", " %");
  replace("_deg_per_100m", " deg/100 m");
  if (column.ends_with("_ms")) replace("_ms", " ms");
  if (column.ends_with("_m")) column.replace(column.size() - 2, 2, " m");
  std::replace(column.begin(), column.end(), '_', ' ');
  return column;
}

bool is_number(const std::string& text) {
  return text.find_first_not_of("0123456789.-+e") == std::string::npos;
}

/// CSS class of a column: the paper's, words, or numbers.
std::string class_of(const CsvTable& table, std::size_t column) {
  if (table.columns[column].starts_with("paper_")) return " class=paper";
  const bool numbers = std::all_of(table.rows.begin(), table.rows.end(),
                                   [column](const auto& row) { return is_number(row[column]); });
  return numbers ? "" : " class=words";
}

std::string html_table(const CsvTable& table) {
  std::string html = "<div class=wide><table>\n<tr><th class=line>line</th>";
  std::vector<std::string> classes;
  for (std::size_t k = 0; k < table.columns.size(); ++k) {
    classes.push_back(class_of(table, k));
    html += fmt::format("<th{}>{}</th>", classes[k], html_text(heading(table.columns[k])));
  }
  html += "</tr>\n";
  std::size_t line = 1;  // the header's
  for (const std::vector<std::string>& row : table.rows) {
    html += row[0] == "mean" ? "<tr class=last>" : "<tr>";
    html += fmt::format("<td class=line>{}</td>", ++line);
    for (std::size_t k = 0; k < row.size(); ++k) {
      html += fmt::format("<td{}>{}</td>", classes[k], html_text(row[k]));
    }
    html += "</tr>\n";
  }
  return html + "</table></div>\n";
}

std::string html_figure(const std::string& folder, const Chart& chart) {
  return fmt::format(
      "<figure><figcaption><b>{}</b>{}</figcaption>\n<img alt=\"{}\" "
      "src=\"data:image/png;base64,{}\"></figure>\n",
      html_text(chart.title), html_text(chart.caption), html_text(chart.title),
      base64(file_bytes(folder + "/" + chart.file)));
}

}  // namespace

std::string html_text(const std::string& text) {
  std::string result;
  for (const char c : text) {
    switch (c) {
      case '&':
        result += "&amp;";
        break;
      case '<':
        result += "&lt;";
        break;
      case '>':
        result += "&gt;";
        break;
      case '"':
        result += "&quot;";
        break;
      default:
        result += c;
    }
  }
  return result;
}

std::string html_report(const std::string& folder, const std::string& summary,
                        const std::vector<ReportTable>& tables, const std::vector<Chart>& charts) {
  std::string html = fmt::format(
      "<!doctype html>\n<html lang=en><head><meta charset=utf-8><title>The LiLO paper's "
      "experiments</title>\n<style>{}</style></head><body>\n<h1>The LiLO paper's experiments</h1>\n"
      "<p>{}</p>\n",
      kStyle, html_text(summary));
  for (const ReportTable& table : tables) {
    html += fmt::format("<h2>{}</h2>\n<p>{} The table is <code>{}</code>.</p>\n",
                        html_text(table.title), html_text(table.note), html_text(table.file));
    html += table.table.rows.empty() ? fmt::format("<p>{}</p>\n", html_text(table.none))
                                     : html_table(table.table);
  }
  for (const Chart& chart : charts) html += html_figure(folder, chart);
  return html + "</body></html>\n";
}

}  // namespace lilo::paper_bench
