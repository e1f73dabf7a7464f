// SPDX-License-Identifier: BSD-3-Clause
// Prints ten poses of lilod: print_poses [HOST [PORT]].   c++ -std=c++17 print_poses.cpp
#include "lilo_client.hpp"

#include <cstdio>
#include <cstdlib>
#include <exception>

int main(int argc, char** argv) try {
  lilo::Client client(argc > 1 ? argv[1] : "127.0.0.1",
                      static_cast<std::uint16_t>(argc > 2 ? std::atoi(argv[2]) : 9871));
  lilo::ClientPose pose;
  for (int count = 0; count < 10; ++count) {
    if (!client.next(pose)) {
      std::fprintf(stderr, "%s\n", client.why().c_str());
      return 1;
    }
    std::printf("%llu %s %.3f %.3f %.3f\n", static_cast<unsigned long long>(pose.seq),
                pose.status.c_str(), pose.position[0], pose.position[1], pose.position[2]);
  }
} catch (const std::exception& error) {
  std::fprintf(stderr, "%s\n", error.what());
  return 1;
}
