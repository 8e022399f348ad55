#include "udp_plant.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <utility>

#include "signal/input_file.h"
#include "signal/number_text.h"

namespace kadans {
namespace {

constexpr int greet_every_ms = 20;

[[noreturn]] void fail_with(const std::string& message) { refuse(message); }

std::string shape(std::string_view robot, std::uint32_t joints, std::uint32_t feet) {
  return "'" + std::string(robot) + "' with " + std::to_string(joints) + " joints and " + std::to_string(feet) +
         " feet";
}

}  // namespace

UdpPlant::UdpPlant(const UdpSettings& settings, const PlantLayout& layout, DatagramSocket socket, std::uint64_t session)
    : settings_(settings), layout_(layout), wire_(layout), socket_(std::move(socket)), session_(session) {
  const double ticks = std::ceil(settings.round_trip_max_s * 1e9 / static_cast<double>(layout.period_ns));
  round_trip_max_ticks_ = static_cast<std::uint64_t>(std::max(2.0, ticks));
}

UdpPlant::~UdpPlant() { close(); }

bool UdpPlant::open(bool (*give_up)() noexcept) {
  using Clock = std::chrono::steady_clock;
  const Clock::time_point end = Clock::now() + std::chrono::duration_cast<Clock::duration>(
                                                   std::chrono::duration<double>(settings_.connect_timeout_s));
  while (Clock::now() < end) {
    if (give_up != nullptr && give_up()) return false;
    if (!welcome_) (void)greet();
    socket_.wait(greet_every_ms);
    if (welcomed()) return true;
  }
  const std::string place = "the plant at " + settings_.peer;
  if (busy_) fail_with(place + " is driven by somebody else");
  fail_with(place + " does not answer within " + printed("%g", settings_.connect_timeout_s) +
            " s: is `kadans plant` running there, and does the network let UDP pass?");
}

bool UdpPlant::greet() { return socket_.send(wire_.greet(next_head(WireKind::hello), out_)); }

bool UdpPlant::welcomed() {
  for (std::size_t count = socket_.receive(), i = 0; i < count; ++i) {
    const Bytes datagram = socket_.datagram(i);
    WireHead head;
    const PlantWire::Check check = wire_.check(datagram, head);
    if (check == PlantWire::Check::garbage || head.session != session_) {
      ++statistics_.refused;
    } else if (head.kind == WireKind::refusal && head.refusal == WireRefusal::busy) {
      busy_ = true;
    } else if (head.kind == WireKind::refusal) {
      refuse(head, datagram);
    } else if (check != PlantWire::Check::good) {
      ++statistics_.refused;
    } else if (head.kind == WireKind::welcome) {
      welcome_ = true;
    } else if (head.kind == WireKind::sensors) {
      sampled_ = take(datagram) || sampled_;
      held_ = newest_;
    }
  }
  return welcome_ && sampled_;
}

void UdpPlant::refuse(const WireHead& head, Bytes datagram) const {
  const WireGreeting theirs = PlantWire::greeting_in(datagram);
  const std::string plant = "the plant at " + settings_.peer;
  const WireGreeting& ours = wire_.greeting();
  if (head.refusal == WireRefusal::other_version)
    fail_with(plant + " speaks another version of the protocol: use the same Kadans on both sides");
  if (head.refusal == WireRefusal::period)
    fail_with(plant + " has a control period of " + std::to_string(theirs.period_ns) + " ns, this robot of " +
              std::to_string(ours.period_ns) + " ns");
  const std::string other = shape(theirs.robot.data(), theirs.joints, theirs.feet);
  const std::string own = shape(ours.robot.data(), ours.joints, ours.feet);
  fail_with(plant + " is another robot: " + other + "; this one is " + own +
            (other == own ? ", but they have other names or another order" : ""));
}

WireHead UdpPlant::next_head(WireKind kind) noexcept {
  return {.kind = kind, .session = session_, .sequence = ++sent_, .time_ns = held_.time_ns};
}

void UdpPlant::send(Bytes datagram) noexcept { ++(socket_.send(datagram) ? statistics_.sent : statistics_.unsent); }

bool UdpPlant::is_good(Bytes datagram, WireHead& head) noexcept {
  const bool good = wire_.check(datagram, head) == PlantWire::Check::good && head.session == session_;
  if (good && (head.kind == WireKind::welcome || head.kind == WireKind::refusal))
    return false;  // of the greeting still
  if (good && head.kind == WireKind::sensors) return true;
  ++statistics_.refused;
  return false;
}

// Whether it is a sample newer than all before.
bool UdpPlant::take(Bytes datagram) noexcept {
  WireHead head;
  if (!is_good(datagram, head) || !arrivals_.is_newest(head.sequence, statistics_)) return false;
  more_ = wire_.sensors_in(datagram, newest_);
  newest_.time_ns = head.time_ns;
  return true;
}

void UdpPlant::read(SensorFrame& sensors) noexcept {
  bool fresh = std::exchange(sampled_, false);  // that of the greeting is new in the first tick
  std::size_t taken = 0, count = 0;
  do {
    count = socket_.receive();
    for (std::size_t i = 0; i < count; ++i) fresh = take(socket_.datagram(i)) || fresh;
    taken += count;
  } while (count == DatagramSocket::batch_max && taken < tick_takes_max);
  if (fresh) {
    answered_ = std::min(more_.answered, written_);
    const std::uint64_t age = written_ - answered_;
    round_trip_ticks_ = static_cast<double>(age);
    const bool good = age <= round_trip_max_ticks_ && taken <= piled_up;
    if (good) held_ = newest_;
    if (!good) ++statistics_.late;
  }
  sensors = held_;
}

void UdpPlant::write(const ActuationFrame& actuation) noexcept {
  ++written_;
  WireHead head = next_head(WireKind::actuation);
  head.sequence = written_;
  send(wire_.actuation(head, actuation, out_));
}

void UdpPlant::close() noexcept {
  if (std::exchange(left_, true) || !welcome_) return;
  for (int i = 0; i < 3; ++i) send(wire_.bye(next_head(WireKind::bye), out_));  // one of them will come
}

void UdpPlant::declare_signals(SignalTable& table) const {
  const auto add = [&](const char* name, const std::uint32_t& count, const char* doc) {
    table.add({std::string("plant.link.") + name, "1", doc}, &count);
  };
  add("received", statistics_.received, "samples that came over the network");
  add("lost", statistics_.lost, "samples that never came");
  add("reordered", statistics_.reordered, "samples that came behind a newer one and were not used");
  add("duplicates", statistics_.duplicates, "samples that came again");
  add("late", statistics_.late, "newest samples that were too old to count as new");
  add("refused", statistics_.refused, "datagrams that were none of this run's plant");
  add("unsent", statistics_.unsent, "actuations that the system did not take");
  table.add({"plant.link.round_trip_ticks", "1", "control ticks since the actuation that the newest sample answers"},
            &round_trip_ticks_);
  table.add({"plant.link.released", "", "the plant's own watchdog damps the joints"}, &more_.released);
}

}  // namespace kadans
