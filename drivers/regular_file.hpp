// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

namespace lilo {

/// The first 1 MiB of a file. Throws DriverError, which calls it `what`, unless it is a regular
/// file: a pipe would be waited for, for ever.
std::string read_regular_file(const std::string& path, const std::string& what);

}  // namespace lilo
