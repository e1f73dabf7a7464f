// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "tests/drivers/packets.hpp"

#include <string>
#include <vector>

namespace lilo::test {

/// The 1206-byte packets of a ROS 2 bag (an SQLite file), in the order they were recorded: reads
/// table leaf pages and their overflow chains (sqlite.org/fileformat2.html, sections 1.6 and 1.7)
/// and takes every 1206 bytes that look like a VLP-16 packet.
std::vector<TimedPacket> packets_of_bag(const std::string& path);

}  // namespace lilo::test
