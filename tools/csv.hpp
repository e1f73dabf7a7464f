// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

namespace lilo {

/// Comma-separated values with a header line, RFC 4180; every row is as long as the header. A field
/// holds no line break.
struct CsvTable {
  std::vector<std::string> columns;
  std::vector<std::vector<std::string>> rows;

  /// Index of a column. Throws std::runtime_error when there is none of that name.
  [[nodiscard]] std::size_t column(const std::string& name) const;
};

/// One line with its end; fields with a comma or a quote are quoted.
std::string csv_line(const std::vector<std::string>& fields);

/// The fields of a line without its end.
std::vector<std::string> csv_fields(const std::string& line);

/// Reads a file. A last line that lacks its end was cut off while it was written and is left out;
/// elsewhere a row of another length than the header is an error. Throws std::runtime_error, one
/// line, "file:line: ...".
CsvTable read_csv(const std::string& path);

/// Writes the whole file, all or nothing. Throws std::runtime_error.
void write_csv(const std::string& path, const CsvTable& table);

}  // namespace lilo
