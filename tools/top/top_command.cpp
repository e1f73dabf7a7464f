// SPDX-License-Identifier: BSD-3-Clause
#include "tools/top/top_command.hpp"

#include "tools/clock.hpp"
#include "tools/connection/address_options.hpp"
#include "tools/stop_signals.hpp"
#include "tools/terminal/screen.hpp"
#include "tools/top/live_view.hpp"

#include <memory>
#include <unistd.h>

namespace lilo {
namespace {

constexpr std::chrono::milliseconds kRedraw{250};  // at the latest: windows change their size
constexpr std::int64_t kShortest_ns = 50'000'000;  // between two pictures

/// Until q or Ctrl-C. A daemon that goes away is waited for.
void watch(Connection& lilod, StopSignals& stop) {
  LiveView view(to_string(lilod.address()), lilod.software());
  const Paint paint(STDOUT_FILENO);
  const Screen screen;
  std::int64_t heard_ns = monotonic_ns(), drawn_ns = 0;
  lilod.subscribe();
  while (!stop.raised() && Screen::key() != 'q') {
    const auto datagram = lilod.receive(kRedraw, stop.descriptor());
    const std::int64_t now_ns = monotonic_ns(), utc_ns = clock_ns(CLOCK_REALTIME);
    if (datagram) {
      heard_ns = now_ns;
      view.take(nlohmann::json::parse(*datagram), utc_ns);
    } else {
      view.silence(static_cast<double>(now_ns - heard_ns) * 1e-9, utc_ns);
    }
    if (now_ns - drawn_ns < kShortest_ns) continue;
    drawn_ns = now_ns;
    const Screen::Size size = Screen::size();
    Screen::draw(view.text(size.rows, size.columns, paint));
  }
}

}  // namespace

void add_top_command(CLI::App& app) {
  auto address = std::make_shared<LilodAddress>();
  CLI::App* sub = app.add_subcommand("top", "How a running lilod is, live; q ends it");
  add_address_options(*sub, *address);
  sub->callback([address] {
    StopSignals stop;
    Connection lilod(*address);
    watch(lilod, stop);
  });
}

}  // namespace lilo
