// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <boost/asio/io_context.hpp>

#include <cstddef>
#include <functional>
#include <string>
#include <thread>

namespace lilo {

/// What became of a request to save.
struct SaveResult {
  std::string error;      ///< empty: it is saved
  std::string file;       ///< its path
  std::size_t count = 0;  ///< points or poses in it
};
using SaveDone = std::function<void(const SaveResult&)>;

/// Where files are saved: the configured directory, or the one systemd made for us
/// (STATE_DIRECTORY), or nowhere (empty).
std::string state_directory(const std::string& configured);

/// Writes one file at a time, on a thread of its own: neither a large text nor a slow disk delays a
/// pose. Files are replaced as a whole, and clients do not choose their names: what they can fill
/// of the disk is bounded.
class Saver {
 public:
  explicit Saver(boost::asio::io_context& io) : io_(io) {}
  /// Waits for the file under way.
  ~Saver();
  Saver(const Saver&) = delete;
  Saver& operator=(const Saver&) = delete;

  [[nodiscard]] bool busy() const { return thread_.joinable(); }
  /// Not while busy. `make` runs on the other thread; `done` on that of the io_context.
  void write(const std::string& file, std::size_t count, std::function<std::string()> make,
             SaveDone done);

 private:
  boost::asio::io_context& io_;
  std::thread thread_;
};

}  // namespace lilo
