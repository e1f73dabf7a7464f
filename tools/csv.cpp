// SPDX-License-Identifier: BSD-3-Clause
#include "tools/csv.hpp"

#include "tools/text_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <iterator>
#include <stdexcept>

namespace lilo {
namespace {

std::string quoted(const std::string& field) {
  if (field.find_first_of(",\"") == std::string::npos) return field;
  std::string result(1, '"');
  for (const char c : field) {
    if (c == '"') result += '"';
    result += c;
  }
  return result + '"';
}

/// The lines of a text that have their end.
std::vector<std::string> whole_lines(const std::string& text) {
  std::vector<std::string> lines;
  std::size_t begin = 0;
  for (std::size_t end; (end = text.find('\n', begin)) != std::string::npos; begin = end + 1) {
    lines.push_back(text.substr(begin, end - begin));
  }
  return lines;
}

}  // namespace

std::size_t CsvTable::column(const std::string& name) const {
  const auto found = std::find(columns.begin(), columns.end(), name);
  if (found == columns.end()) {
    throw std::runtime_error(fmt::format("expected a column {}, found none", name));
  }
  return static_cast<std::size_t>(found - columns.begin());
}

std::string csv_line(const std::vector<std::string>& fields) {
  std::string line;
  for (std::size_t k = 0; k < fields.size(); ++k) {
    if (k > 0) line += ',';
    line += quoted(fields[k]);
  }
  return line + '\n';
}

std::vector<std::string> csv_fields(const std::string& line) {
  std::vector<std::string> fields(1);
  bool inside = false;
  for (std::size_t k = 0; k < line.size(); ++k) {
    const char c = line[k];
    if (inside && c == '"' && k + 1 < line.size() && line[k + 1] == '"') {
      fields.back() += line[++k];
    } else if (c == '"') {
      inside = !inside;
    } else if (c == ',' && !inside) {
      fields.emplace_back();
    } else {
      fields.back() += c;
    }
  }
  return fields;
}

CsvTable read_csv(const std::string& path) {
  std::ifstream file = open_text(path);
  const std::string text{std::istreambuf_iterator<char>(file), {}};
  CsvTable table;
  int number = 0;
  for (const std::string& line : whole_lines(text)) {
    std::vector<std::string> fields = csv_fields(line);
    if (++number == 1) {
      table.columns = std::move(fields);
    } else if (fields.size() == table.columns.size()) {
      table.rows.push_back(std::move(fields));
    } else {
      throw std::runtime_error(fmt::format("{}:{}: expected {} fields, found {}", path, number,
                                           table.columns.size(), fields.size()));
    }
  }
  return table;
}

void write_csv(const std::string& path, const CsvTable& table) {
  const std::string unfinished = path + ".part";
  std::ofstream file = create_text(unfinished);
  file << csv_line(table.columns);
  for (const std::vector<std::string>& row : table.rows) file << csv_line(row);
  finish_text(file, unfinished);
  std::filesystem::rename(unfinished, path);
}

}  // namespace lilo
