// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <string_view>
#include <system_error>

namespace lilo {

/// Where the metrics go: the configured path, or lilo.prom in the folder systemd made for us
/// (RUNTIME_DIRECTORY), or nowhere (empty).
std::string metrics_path(const std::string& configured);

/// Replaces the file as a whole, so that no reader sees half of it; readable by all. What stands in
/// the place of its draft (path + ".new") and is no regular file, a link, a pipe or a device, is
/// neither followed nor waited for. Nothing, or why it cannot be written.
std::error_code replace_file(const std::string& path, std::string_view text);

}  // namespace lilo
