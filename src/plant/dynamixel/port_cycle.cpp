#include "port_cycle.h"

#include <algorithm>

#include "kadans/signal/input_error.h"

namespace kadans::dynamixel {
namespace {

constexpr std::int64_t slack_ns = 1'000'000;   // beyond the line's own time and the adapter's
constexpr std::uint32_t missed_max = 3;        // reads in a row before a servo is asked alone
constexpr std::uint32_t missed_alone_max = 6;  // before it counts as silent
constexpr int pings = 50;                      // of a servo whose supply was just switched on
constexpr int looks = 5;                       // at where it stands

std::string id_and_drive(const Servo& servo) {
  return "servo " + std::to_string(servo.id()) + " ('" + servo.settings().drive + "')";
}

}  // namespace

PortCycle::PortCycle(SerialPort& port, const Timing& timing, std::vector<Servo> servos)
    : port_(port), timing_(timing), servos_(std::move(servos)), bus_(port, timing.baud, timing.patience_ns) {
  sample_.count = static_cast<std::uint32_t>(servos_.size());
}

void PortCycle::fail(const Servo& servo, const std::string& where, const std::string& why) const {
  throw InputError(servo.settings().place.with(id_and_drive(servo) + " on " + where + " " + why));
}

std::string PortCycle::others_that_answer(const Servo& but) {
  std::string ids;
  for (const Servo& servo : servos_) {
    ServoBus::Identity identity;
    if (servo.id() == but.id() || bus_.ping(servo.id(), identity) != Answer::good) continue;
    ids += (ids.empty() ? "" : ", ") + std::to_string(servo.id());
  }
  return ids.empty() ? "no other one does" : "these do: " + ids;
}

void PortCycle::check_servo(const Servo& servo, const std::string& where) {
  ServoBus::Identity is;
  Answer answer = Answer::silence;
  bool disturbed = false;
  for (int i = 0; i < pings && answer != Answer::good; ++i) {
    answer = bus_.ping(servo.id(), is);
    disturbed = disturbed || answer == Answer::garbage;
  }
  // Two of the same kind may answer a ping as one. Where they stand, they differ.
  std::uint32_t position = 0;
  for (int i = 0; i < looks && answer == Answer::good; ++i)
    disturbed = bus_.read(servo.id(), present_position, position) == Answer::garbage || disturbed;
  if (disturbed)
    fail(servo, where,
         "answers garbage: two servos have this id, or the line is disturbed. Connect one alone and look at it with "
         "`kadans dynamixel scan`");
  if (answer != Answer::good)
    fail(servo, where,
         "does not answer at " + std::to_string(timing_.baud) + " baud; " + others_that_answer(servo) +
             ". Is it powered, and does `kadans dynamixel scan` find it at another baud rate or id?");
  const ServoModel* const model = find_model(is.model);
  const std::string found = model != nullptr ? std::string(model->name) : "model " + std::to_string(is.model);
  if (model != &servo.model())
    fail(servo, where, "is " + found + ", the configuration says " + std::string(servo.model().name));
  if (is.firmware < servo.model().fast_read_from) fast_ = false;
  std::uint32_t error = 0;
  if (bus_.read(servo.id(), hardware_error, error) == Answer::good && error != 0)
    fail(servo, where,
         "reports a hardware error: " + std::string(hardware_error_words(error)) +
             ". Remove the cause, then switch its power off and on");
}

bool PortCycle::open(const std::string& where, bool (*give_up)() noexcept) {
  fast_ = true;
  for (Servo& servo : servos_) {
    if (give_up != nullptr && give_up()) return false;
    check_servo(servo, where);
  }
  for (Servo& servo : servos_) {
    servo.start_set_up();
    Servo::SetUp state = Servo::SetUp::goes_on;
    while ((state = servo.set_up(bus_)) == Servo::SetUp::goes_on) {
    }
    if (state == Servo::SetUp::failed)
      fail(servo, where,
           bus_.error() != 0 ? "refuses its settings: " + std::string(status_error_words(bus_.error()))
                             : "stopped answering while it was set up: look at its plugs and its supply");
  }
  sent_ns_ = port_.now_ns();
  list_working();
  return true;
}

void PortCycle::close() noexcept {
  std::array<std::uint8_t, max_joints> all{};
  for (std::size_t i = 0; i < servos_.size(); ++i) all[i] = servos_[i].id();
  const Octets ids(all.data(), servos_.size());
  for (int i = 0; i < 3; ++i) (void)bus_.write_to_all(torque_enable, 0, ids);  // one of them arrives
  for (const Servo& servo : servos_) {
    if (servo.stage() == Servo::Stage::working) (void)bus_.write(servo.id(), bus_watchdog, 0);
  }
}

void PortCycle::list_working() noexcept {
  working_ = 0;
  for (std::size_t i = 0; i < servos_.size(); ++i) {
    if (servos_[i].stage() != Servo::Stage::working) continue;
    ids_[working_] = servos_[i].id();
    which_[working_++] = i;
  }
}

void PortCycle::put(Octets packet) noexcept {
  if (out_size_ + packet.size() > out_.size()) return;
  std::ranges::copy(packet, out_.begin() + static_cast<std::ptrdiff_t>(out_size_));
  out_size_ += packet.size();
}

void PortCycle::put_goals() noexcept {
  const IndirectLayout& layout = servos_[which_[0]].layout();
  PacketWriter packet(broadcast_id, Instruction::sync_write);
  packet.u16(layout.write_address()).u16(static_cast<std::uint16_t>(layout.write_bytes()));
  for (std::size_t i = 0; i < working_; ++i) {
    const ServoGoals& goals = servos_[which_[i]].goals();
    packet.u8(ids_[i]);
    for (const Register& one : layout.writes()) {
      if (one == goal_pwm) packet.u16(static_cast<std::uint16_t>(goals.pwm));
      if (one == goal_current) packet.u16(static_cast<std::uint16_t>(goals.current));
      if (one == goal_velocity) packet.u32(static_cast<std::uint32_t>(goals.velocity));
      if (one == goal_position) packet.u32(static_cast<std::uint32_t>(goals.position));
      if (one == torque_enable) packet.u8(goals.torque ? 1 : 0);
    }
  }
  put(packet.finish());
}

void PortCycle::put_read(std::uint16_t address, std::size_t bytes) noexcept {
  PacketWriter packet(broadcast_id, fast_ ? Instruction::fast_sync_read : Instruction::sync_read);
  packet.u16(address).u16(static_cast<std::uint16_t>(bytes));
  for (std::size_t i = 0; i < working_; ++i) packet.u8(ids_[i]);
  put(packet.finish());
}

// Sends what was put, and gives the answer of each working servo to take(index, data, time), `bytes` each.
template <typename Take>
void PortCycle::receive(std::size_t bytes, Take take) noexcept {
  scanner_.clear();
  port_.discard();
  const std::uint64_t corrupt_before = scanner_.counts().corrupt;
  const std::int64_t begin_ns = port_.now_ns();
  (void)port_.send({out_.data(), out_size_});
  sent_ns_ = begin_ns;
  const std::size_t block = bytes + (fast_ ? fast_block_overhead : status_bytes_min);
  const std::size_t head = fast_ ? 8 : 0, answer = head + working_ * block;
  const std::int64_t asked_ns = begin_ns + wire_ns(out_size_, timing_.baud);
  const std::int64_t until_ns = asked_ns + wire_ns(answer, timing_.baud) + timing_.usb_latency_ns + slack_ns;
  out_size_ = 0;
  // When it measured: not before it was asked, nor after its answer is here.
  const auto measured_ns = [&](std::size_t index) {
    return std::min(asked_ns + wire_ns(head + index * block, timing_.baud), port_.now_ns());
  };
  std::array<bool, max_joints> came{};
  std::size_t count = 0;
  ReceivedPacket packet;
  while (count < working_) {
    while (scanner_.next(packet)) {
      if (fast_) {
        const FastAnswer whole(packet, {ids_.data(), working_}, bytes);
        for (std::size_t i = 0; whole.good() && i < working_; ++i) {
          take(which_[i], whole.block(i).data, measured_ns(i));
          came[i] = true;
          ++count;
        }
        if (!whole.good()) ++counts_.corrupt;
        if (whole.good()) break;
        continue;
      }
      const std::span<const std::uint8_t> asked(ids_.data(), working_);
      const auto i = static_cast<std::size_t>(std::ranges::find(asked, packet.id) - asked.begin());
      if (packet.instruction != static_cast<std::uint8_t>(Instruction::status)) continue;
      if (i == working_ || came[i] || packet.data.size() != bytes) {
        ++counts_.corrupt;
        continue;
      }
      take(which_[i], packet.data, measured_ns(i));
      came[i] = true;
      ++count;
    }
    if (count >= working_) break;
    const std::size_t more = port_.receive(scanner_.room(), until_ns);
    if (more == 0) break;
    scanner_.filled(more);
  }
  counts_.corrupt += static_cast<std::uint32_t>(scanner_.counts().corrupt - corrupt_before);
  for (std::size_t i = 0; i < working_; ++i) {
    if (!came[i]) servos_[which_[i]].miss();
  }
}

// Writes the operating modes that servos wait for, and asks for those that they have now.
void PortCycle::change_modes() noexcept {
  PacketWriter packet(broadcast_id, Instruction::sync_write);
  packet.u16(operating_mode.address).u16(operating_mode.bytes);
  bool any = false;
  for (std::size_t i = 0; i < working_; ++i) {
    const OperatingMode wanted = servos_[which_[i]].wants_mode();
    if (wanted == OperatingMode::unknown) continue;
    packet.u8(ids_[i]).u8(static_cast<std::uint8_t>(wanted));
    any = true;
  }
  if (!any) return;
  put(packet.finish());
  put_read(operating_mode.address, operating_mode.bytes);
  receive(operating_mode.bytes, [&](std::size_t which, Octets data, std::int64_t) {
    servos_[which].has_mode(static_cast<OperatingMode>(data[0]));
  });
}

// What one servo needs beside the cycle: a reboot, the next step of its settings, a question whether it is there.
void PortCycle::serve_one() noexcept {
  for (std::size_t i = 0; i < servos_.size(); ++i) {
    next_served_ = next_served_ + 1 < servos_.size() ? next_served_ + 1 : 0;
    Servo& servo = servos_[next_served_];
    if (servo.wants_reboot()) {
      (void)bus_.reboot(servo.id());
      servo.rebooted(port_.now_ns());
    } else if (servo.stage() == Servo::Stage::setting_up) {
      (void)servo.set_up(bus_);
    } else if (servo.stage() == Servo::Stage::working && servo.missed() >= missed_max) {
      ServoBus::Identity identity;
      if (bus_.ping(servo.id(), identity) == Answer::good) continue;
      if (servo.missed() >= missed_alone_max) servo.give_up(code_silent);
    } else {
      continue;
    }
    sent_ns_ = port_.now_ns();
    return;
  }
}

// After a long silence of ours the servos' watchdogs have stopped them, and take no goals until they are set anew.
void PortCycle::rearm_watchdogs() noexcept {
  if (working_ == 0 || 1e-9 * static_cast<double>(port_.now_ns() - sent_ns_) < 0.8 * timing_.watchdog_s) return;
  const Octets ids(ids_.data(), working_);
  (void)bus_.write_to_all(bus_watchdog, 0, ids);
  (void)bus_.write_to_all(bus_watchdog, servos_[which_[0]].watchdog_units(), ids);
}

void PortCycle::tell() noexcept {
  counts_.limited = 0;
  for (std::size_t i = 0; i < servos_.size(); ++i) {
    sample_.servos[i] = servos_[i].reading();
    counts_.limited += servos_[i].limited();
  }
  sample_.counts = counts_;
}

void PortCycle::run(const ActuationFrame& drives) noexcept {
  const std::int64_t begin_ns = port_.now_ns();
  ++counts_.cycles;
  rearm_watchdogs();
  for (Servo& servo : servos_) {
    const bool there = servo.joint() < drives.joint_count;
    servo.plan(there ? drives.joints[servo.joint()] : JointActuation{},
               there ? drives.drives[servo.joint()] : DriveRequest{}, begin_ns);
  }
  list_working();
  if (working_ > 0) {
    const std::uint32_t came_before = counts_.answers + counts_.strange;
    const IndirectLayout layout = servos_[which_[0]].layout();
    put_goals();
    put_read(layout.read_address(), layout.read_bytes());
    receive(layout.read_bytes(), [&](std::size_t which, Octets data, std::int64_t time_ns) {
      const bool good = servos_[which].take(data, time_ns);
      ++(good ? counts_.answers : counts_.strange);
    });
    counts_.lost += static_cast<std::uint32_t>(working_) - (counts_.answers + counts_.strange - came_before);
    sample_.cycle_ms = 1e-6 * static_cast<double>(port_.now_ns() - begin_ns);
    change_modes();
  }
  serve_one();
  if (port_.now_ns() - begin_ns > timing_.period_ns) ++counts_.late;
  tell();
}

}  // namespace kadans::dynamixel
