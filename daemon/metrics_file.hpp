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

/// A file that is replaced time and again, without allocation.
class ReplacedFile {
 public:
  /// An empty path: there is no file.
  explicit ReplacedFile(const std::string& path) : path_(path), draft_(path + ".new") {}

  [[nodiscard]] bool is_none() const { return path_.empty(); }
  /// As replace_file(). True when there is no file.
  [[nodiscard]] bool write(std::string_view text) const;

 private:
  std::string path_, draft_;
};

}  // namespace lilo
