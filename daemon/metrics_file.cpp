#include "daemon/metrics_file.hpp"

#include <cstdio>
#include <cstdlib>
#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

namespace lilo {

std::string metrics_path(const std::string& configured) {
  if (!configured.empty()) return configured;
  const char* const folder = std::getenv("RUNTIME_DIRECTORY");  // NOLINT(concurrency-mt-unsafe)
  return folder == nullptr ? "" : std::string(folder) + "/lilo.prom";
}

bool replace_file(const std::string& path, std::string_view text) {
  if (path.empty()) return false;
  const std::string draft = path + ".new";
  const int fd = open(draft.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0644);
  if (fd < 0) return false;
  // The unit's umask is 0077, but who collects metrics is another user.
  const bool readable = fchmod(fd, 0644) == 0;
  const bool whole = ::write(fd, text.data(), text.size()) == static_cast<ssize_t>(text.size());
  close(fd);
  if (readable && whole && std::rename(draft.c_str(), path.c_str()) == 0) return true;
  std::remove(draft.c_str());
  return false;
}

}  // namespace lilo
