#pragma once

#include <string>
#include <string_view>

namespace lilo {

/// Where the metrics go: the configured path, or lilo.prom in the folder systemd made for us
/// (RUNTIME_DIRECTORY), or nowhere (empty).
std::string metrics_path(const std::string& configured);

/// Replaces the file as a whole, so that no reader sees half of it; readable by all. False when it
/// cannot be written.
bool replace_file(const std::string& path, std::string_view text);

}  // namespace lilo
