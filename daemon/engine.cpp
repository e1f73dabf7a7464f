// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/engine.hpp"

#include "daemon/beam_keeper.hpp"
#include "daemon/saver.hpp"

#include <future>
#include <optional>
#include <pthread.h>
#include <string>
#include <utility>
#include <vector>

namespace lilo {
namespace {

constexpr std::size_t kReportSlots = 64;  // 6 s of poses while the publisher is held up
constexpr std::size_t kPointsSlots = 4;
constexpr std::size_t kPacketSlots = 1024;  // 1.3 MB: 0.3 s of an HDL-64E
constexpr std::size_t kThreadStackBytes = 512 << 10;

/// What a thread tells of itself before it starts work.
struct ThreadStart {
  ThreadPolicy policy;
  std::vector<std::string> refusals;
};

ThreadStart enter_thread(const char* name, int cpu, int priority) {
  ThreadStart out;
  const auto note = [&](const std::optional<std::string>& refusal) {
    if (refusal) out.refusals.push_back(std::string(name) + ": " + *refusal);
  };
  pthread_setname_np(pthread_self(), name);
  if (cpu >= 0) note(pin_this_thread(cpu));
  if (priority > 0) note(use_fifo_in_this_thread(priority));
  out.policy = policy_of_this_thread();
  return out;
}

template <typename Work>
std::thread start_thread(const char* name, int cpu, int priority, std::future<ThreadStart>& started,
                         Work work) {
  std::promise<ThreadStart> promise;
  started = promise.get_future();
  return std::thread([=, promise = std::move(promise)]() mutable {
    promise.set_value(enter_thread(name, cpu, priority));
    work();
  });
}

SensorConfig sensor_config(const Config& config) {
  SensorConfig sensor = config.sensor;
  sensor.state_directory = state_directory(config.state.directory);
  return sensor;
}

ScanRing& prepared(ScanRing& scans, const Config& config) {
  scans.for_each_slot(
      [&](ScanSlot& slot) { prepare_slot(slot, config.sensor.model, config.odometry); });
  return scans;
}

/// Nothing where no errors are estimated.
BeamEstimate resumed_beams(const Config& config) {
  if (!estimates_beams(config.odometry)) return {};
  return kept_beams(state_directory(config.state.directory));
}

PointsOutput prepared(PointsRing& points, const SubscribeConfig& config) {
  const PointsOutput out{points, static_cast<std::size_t>(config.scan_points),
                         static_cast<std::size_t>(config.map_points)};
  // With a value, so that the memory is touched before it is needed.
  points.for_each_slot([&](PointsReport& slot) {
    slot.scan_m.assign(out.most_of_scan, Eigen::Vector3f::Zero());
    slot.map_m.assign(out.most_of_map, Eigen::Vector3f::Zero());
  });
  return out;
}

}  // namespace

Engine::Engine(const Config& config, std::unique_ptr<PacketSource> source)
    : realtime_(config.realtime),
      scans_(static_cast<std::size_t>(config.realtime.ring_slots)),
      reports_(kReportSlots),
      points_(kPointsSlots),
      packets_(config.subscribe.packets_clients > 0 ? kPacketSlots : 0),
      receiver_(std::move(source), sensor_config(config), config.odometry, prepared(scans_, config),
                scan_ready_, counters_, &packets_),
      worker_(config.odometry, resumed_beams(config), scans_, scan_ready_, reports_,
              prepared(points_, config.subscribe), report_ready_, counters_) {}

Engine::~Engine() { stop(); }

RealtimeReport Engine::start() {
  RealtimeReport report;
  const auto note = [&](const std::optional<std::string>& refusal) {
    if (refusal) report.refusals.push_back(*refusal);
  };
  note(limit_stack_of_new_threads(kThreadStackBytes));
  if (realtime_.lock_memory)
    note(lock_all_memory(static_cast<std::size_t>(realtime_.reserve_mb) << 20U));

  const int priority = realtime_.worker_priority;
  std::future<ThreadStart> worker, receiver;
  worker_thread_ = start_thread("lilo-worker", realtime_.worker_cpu, priority, worker,
                                [this] { worker_.run(); });
  // One above the worker: a packet not taken in time is gone for good.
  receiver_thread_ = start_thread("lilo-receiver", -1, priority > 0 ? priority + 1 : 0, receiver,
                                  [this] { receiver_.run(); });
  for (auto [started, policy] :
       {std::pair{&worker, &report.worker}, std::pair{&receiver, &report.receiver}}) {
    ThreadStart start = started->get();
    *policy = start.policy;
    for (std::string& refusal : start.refusals) report.refusals.push_back(std::move(refusal));
  }
  // One below: it is there at once when a pose is, and never in the way of the next one.
  if (priority > 1) note(use_fifo_in_this_thread(priority - 1));
  report.publisher = policy_of_this_thread();
  report.locked_memory_kb = locked_memory_kb();
  return report;
}

bool Engine::reset() {
  if (counters_.resets_asked != counters_.resets_done) return false;
  ++counters_.resets_asked;
  return true;
}

bool Engine::ask_map() {
  if (map_asked_) return false;
  map_asked_ = true;
  ++counters_.maps_asked;
  scan_ready_.signal();
  return true;
}

std::optional<MapCopy> Engine::take_map() {
  if (!map_asked_ || counters_.maps_asked != counters_.maps_done) return std::nullopt;
  map_asked_ = false;
  return std::exchange(worker_.map_copy(), {});
}

void Engine::stop() {
  counters_.stop.store(true);
  scan_ready_.signal();
  if (receiver_thread_.joinable()) receiver_thread_.join();
  if (worker_thread_.joinable()) worker_thread_.join();
}

}  // namespace lilo
