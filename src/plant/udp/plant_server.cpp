#include "plant_server.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace kadans {

PlantServer::PlantServer(const UdpSettings& settings, const PlantLayout& layout, DatagramSocket socket)
    : settings_(settings), wire_(layout), socket_(std::move(socket)), period_ns_(layout.period_ns) {}

bool PlantServer::step_with_peer() noexcept {
  settings_.watchdog_s = settings_.peer_timeout_s = in_step_timeout_s;
  return in_step_ = true;
}

bool PlantServer::await(int milliseconds) noexcept {
  in_session_ = answered_stranger_ = false;
  socket_.wait(milliseconds);
  take_all();
  return in_session_;
}

void PlantServer::begin(std::uint64_t session, const PeerAddress& from) noexcept {
  in_session_ = true;
  peer_ = from;
  session_number_ = session;
  sent_ = newest_actuation_ = stepped_ = 0;
  silent_ns_ = 0;
  driven_ = released_ = false;
  actuation_ = {};
  arrivals_ = {};
  session_ = {};
  link_ = {};
}

void PlantServer::answer(WireKind kind, WireRefusal refusal, std::uint64_t session, const PeerAddress& to) noexcept {
  (void)socket_.send(wire_.greet({.kind = kind, .refusal = refusal, .session = session}, out_), to);
}

// Whether it was a greeting. Who is refused is told so, one in a beat.
bool PlantServer::greeted(const WireHead& head, PlantWire::Check check, Bytes datagram,
                          const PeerAddress& from) noexcept {
  if (check == PlantWire::Check::garbage || head.kind != WireKind::hello) return false;
  WireRefusal refusal = WireRefusal::none;
  if (check == PlantWire::Check::other_version) refusal = WireRefusal::other_version;
  if (check == PlantWire::Check::other_layout) refusal = WireRefusal::layout;
  if (refusal == WireRefusal::none && PlantWire::greeting_in(datagram).period_ns != period_ns_)
    refusal = WireRefusal::period;
  const bool again = in_session_ && from == peer_ && head.session == session_number_;
  if (refusal == WireRefusal::none && in_session_ && !again) refusal = WireRefusal::busy;
  if (refusal != WireRefusal::none) {
    ++link_.refused;
    if (!std::exchange(answered_stranger_, true)) answer(WireKind::refusal, refusal, head.session, from);
    return true;
  }
  if (!in_session_) begin(head.session, from);
  answer(WireKind::welcome, WireRefusal::none, session_number_, peer_);
  return true;
}

void PlantServer::take(Bytes datagram, const PeerAddress& from) noexcept {
  WireHead head;
  const PlantWire::Check check = wire_.check(datagram, head);
  if (greeted(head, check, datagram, from)) return;
  const bool ours = in_session_ && check == PlantWire::Check::good && from == peer_ && head.session == session_number_;
  if (ours && head.kind == WireKind::bye) {
    session_.left = true;
  } else if (ours && head.kind == WireKind::actuation) {
    take_actuation(head, datagram);
  } else {
    ++link_.refused;
  }
}

void PlantServer::take_actuation(const WireHead& head, Bytes datagram) noexcept {
  if (!arrivals_.is_newest(head.sequence, link_)) return;
  wire_.actuation_in(datagram, actuation_);
  newest_actuation_ = head.sequence;
  silent_ns_ = 0;
  driven_ = true;
  if (head.time_ns < 0 || head.time_ns > sensors_.time_ns) return;  // of before the first sample, or of none of ours
  const std::int64_t age_ns = sensors_.time_ns - head.time_ns;
  session_.answer_max_ns = std::max(session_.answer_max_ns, age_ns);
  session_.answer_sum_ns += static_cast<double>(age_ns);
  ++session_.answers;
}

void PlantServer::take_all() noexcept {
  std::size_t taken = 0, count = 0;
  do {
    count = socket_.receive();
    for (std::size_t i = 0; i < count; ++i) take(socket_.datagram(i), socket_.from(i));
    taken += count;
  } while (count == DatagramSocket::batch_max && taken < beat_takes_max);
}

// What a drive does without its bus: torque against the motion, within the drive's limit.
const ActuationFrame& PlantServer::damping(const PlantTruth& truth) noexcept {
  damping_.joint_count = truth.joint_count;
  damping_.drives = actuation_.drives;  // the same orders, not new ones
  for (std::size_t i = 0; i < truth.joint_count; ++i) {
    const double effort_Nm = -settings_.damping_Nms_per_rad * truth.velocity_rad_s[i];
    damping_.joints[i] = {.effort_Nm = std::isfinite(effort_Nm) ? effort_Nm : 0, .mode = ActuationMode::effort};
  }
  return damping_;
}

// How many of the periods pass for the world. In step, what the peer is ahead by more than that is lost.
std::uint32_t PlantServer::due(std::uint32_t periods) noexcept {
  if (!driven_) return 0;
  if (!in_step_) return periods;
  const std::uint64_t ahead = newest_actuation_ - std::exchange(stepped_, newest_actuation_);
  return static_cast<std::uint32_t>(std::min<std::uint64_t>(ahead, std::max(periods, in_step_ahead_max)));
}

bool PlantServer::beat(World& world, std::uint32_t periods) {
  WorldRobot& robot = world.robot(0);
  answered_stranger_ = false;
  take_all();
  if (session_.left) return false;
  const bool released =
      driven_ && static_cast<double>(silent_ns_) > 1e9 * settings_.watchdog_s;  // and again one that is driven
  if (released && !released_) ++session_.releases;
  released_ = released;
  const std::uint32_t due = this->due(periods);
  for (std::uint32_t i = 0; i < due; ++i) {
    robot.write(released ? damping(robot.truth()) : actuation_);
    world.step(period_ns_);
  }
  silent_ns_ += static_cast<std::int64_t>(periods) * period_ns_;
  if (static_cast<double>(silent_ns_) > 1e9 * settings_.peer_timeout_s) return false;
  if (in_step_ && driven_ && due == 0) return true;  // the peer has had this sample
  robot.read(sensors_);
  const WireHead head{
      .kind = WireKind::sensors, .session = session_number_, .sequence = ++sent_, .time_ns = sensors_.time_ns};
  const SensorsOnWire more{.answered = newest_actuation_, .released = released_};
  ++(socket_.send(wire_.sensors(head, more, sensors_, out_), peer_) ? link_.sent : link_.unsent);
  return true;
}

}  // namespace kadans
