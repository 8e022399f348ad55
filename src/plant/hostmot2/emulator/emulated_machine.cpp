#include "emulated_machine.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "kadans/signal/input_error.h"

namespace kadans::hostmot2 {
namespace {

struct Kind {
  const char* name;
  unsigned ports, width;
};
constexpr Kind kinds[] = {{"7I96", 3, 17}, {"7I92", 2, 17}, {"7I76E-16", 3, 17}, {"5I20", 3, 24}, {"4I65", 3, 24}};

constexpr EmulatedFaultKind board_faults[] = {
    {"datagrams_lost", EmulatedFaultKind::Of::line, "share of the datagrams"},
    {"datagrams_corrupt", EmulatedFaultKind::Of::line, "share of the datagrams"},
    {"datagrams_twice", EmulatedFaultKind::Of::line, "share of the datagrams"},
    {"datagrams_late", EmulatedFaultKind::Of::line, "share of the datagrams"},
    {"cable_out", EmulatedFaultKind::Of::line, ""},
    {"watchdog_bites", EmulatedFaultKind::Of::line, ""},
    {"board_reboots", EmulatedFaultKind::Of::line, ""},
    {"drive_tripped", EmulatedFaultKind::Of::drive, ""},
    {"emergency_button", EmulatedFaultKind::Of::nothing, ""},
};

}  // namespace

EmulatedMachine::EmulatedMachine(const HostMot2Settings& settings, const PlantSite& site, std::uint64_t seed)
    : shafts_(site),
      emergency_{.board = settings.board_number(settings.emergency_board), .is = {.pin = settings.emergency}} {
  for (const BoardSettings& board : settings.boards) {
    names_.push_back(board.name);
    const auto refuse = [&](const std::string& why) { throw InputError(board.place.with(why)); };
    const auto* const kind = std::ranges::find(kinds, board.card, &Kind::name);
    if (kind == std::end(kinds))
      refuse("there is no emulator of a '" + board.card + "'; there are 7I96, 7I92, 7I76E-16, 5I20 and 4I65");
    EmulatedBoard::Settings is{
        .name = board.card, .ports = kind->ports, .width = kind->width, .encoders = 0, .pwms = 0};
    for (const DriveWiring& drive : settings.drives) {
      if (drive.board != board.name) continue;
      is.encoders = std::max(is.encoders, drive.encoder + 1);
      if (drive.pwm) is.pwms = std::max(is.pwms, *drive.pwm + 1);
    }
    try {
      boards_.emplace_back(is);
    } catch (const std::invalid_argument& error) {
      refuse(error.what());
    }
    wires_.emplace_back(boards_.back(), seed + boards_.size());
  }
  for (const DriveWiring& drive : settings.drives)
    wired_.push_back({.board = settings.board_number(drive.board), .joint = shafts_.place(drive.drive), .is = drive});
  for (const FootWiring& foot : settings.feet) {
    const std::vector<std::string>& feet = site.layout.feet;
    const auto number = static_cast<std::size_t>(std::ranges::find(feet, foot.foot) - feet.begin());
    if (number < feet.size()) feet_.push_back({settings.board_number(foot.board), number, foot});
  }
  for (const InputWiring& input : settings.inputs) inputs_.push_back({settings.board_number(input.board), input});
}

EmulatedMachine::Wired& EmulatedMachine::at(std::size_t joint) noexcept {
  return *std::ranges::find(wired_, joint, &Wired::joint);
}

void EmulatedMachine::fail_amplifier(std::size_t joint, bool fails) noexcept { at(joint).fails = fails; }

void EmulatedMachine::block(std::size_t joint, double low_rad, double high_rad) noexcept {
  at(joint).low_rad = low_rad;
  at(joint).high_rad = high_rad;
}

void EmulatedMachine::set_sensor(const std::string& name, bool active) noexcept {
  for (Input& one : inputs_) {
    if (one.is.name == name) one.active = active;
  }
}

bool EmulatedMachine::output(std::size_t board, const OptionalPin& pin) const noexcept {
  if (!pin || !boards_[board].driven(pin->number)) return false;
  return (boards_[board].level(pin->number) > 0.5) != pin->low;
}

void EmulatedMachine::input(std::size_t board, const OptionalPin& pin, bool active) noexcept {
  if (pin) boards_[board].set_input(pin->number, active != pin->low);
}

void EmulatedMachine::look(WorldRobot& robot) {
  shafts_.look(robot);
  for (const Wired& w : wired_) {
    EmulatedBoard& board = boards_[w.board];
    const double position_rad = w.is.spring_Nm_per_rad > 0 ? shafts_.joint_rad(w.joint) : shafts_.position_rad(w.joint);
    const double sign = w.is.reversed ? -1 : 1;
    board.turn_to(w.is.encoder, std::llround(sign * (position_rad - w.is.home_rad) * w.is.counts_per_rad));
    if (!looked_ && w.is.home != Home::power_on) (void)board.write(0x3000 + 4 * w.is.encoder, 0);
    const bool past_home = w.is.home_rad_s >= 0 ? position_rad >= w.is.home_rad : position_rad <= w.is.home_rad;
    board.probe(w.is.encoder, past_home);
    input(w.board, w.is.home_switch, past_home);
    input(w.board, w.is.low, position_rad <= w.low_rad);
    input(w.board, w.is.high, position_rad >= w.high_rad);
    input(w.board, w.is.fault, w.fails);
  }
  looked_ = true;
  for (const Foot& foot : feet_) {
    const auto& force_N = shafts_.sensors().feet[foot.number].force_N;
    for (std::size_t i = 0; i < force_N.size(); ++i)
      input(foot.board, foot.is.corners[i], force_N[i] > foot.is.closed_N / 2);
  }
  for (const Input& one : inputs_) input(one.board, one.is.pin, one.active);
  input(emergency_.board, emergency_.is.pin, emergency_.active);
}

bool EmulatedMachine::enabled(std::size_t joint) const noexcept {
  const auto found = std::ranges::find(wired_, joint, &Wired::joint);
  return found->is.pwm && !found->fails && (!found->is.enable || output(found->board, found->is.enable));
}

// What the amplifier makes of the two lines to it.
double EmulatedMachine::duty(const Wired& w) const noexcept {
  const EmulatedBoard& board = boards_[w.board];
  const unsigned pin = board.pwm_pin(*w.is.pwm);
  const double first = board.level(pin), second = board.level(pin + 1);
  double is = 0;
  switch (w.is.output) {
    case PwmOutput::pwm_dir:
    case PwmOutput::pdm:
      is = second > 0.5 ? -first : first;
      break;
    case PwmOutput::dir_pwm:
      is = first > 0.5 ? -second : second;
      break;
    case PwmOutput::up_down:
      is = second - first;
      break;
  }
  return w.is.pwm_reversed ? -is : is;
}

void EmulatedMachine::drive(WorldRobot& robot) {
  for (const Wired& w : wired_) {
    if (!w.is.pwm) continue;
    const AmplifierSettings& a = w.is.amplifier;
    const double turn_Nm_per_A = a.Nm_per_A * a.gear * a.efficiency;
    JointActuation does;
    if (enabled(w.joint) && a.kind == AmplifierSettings::Kind::current)
      does = {.effort_Nm = duty(w) * a.full * turn_Nm_per_A, .mode = ActuationMode::effort};
    if (enabled(w.joint) && a.kind == AmplifierSettings::Kind::voltage)
      does = motor_at_voltage(duty(w), a.full / a.winding_Ohm * turn_Nm_per_A, a.full / (a.Nm_per_A * a.gear));
    if (enabled(w.joint) && a.kind == AmplifierSettings::Kind::velocity)
      does = {.velocity_rad_s = duty(w) * a.full / a.gear,
              .damping_Nms_per_rad = a.gain_Nms_per_rad,
              .mode = ActuationMode::impedance};
    shafts_.set(w.joint, does);
    if (w.is.brake) shafts_.set_brake(w.joint, output(w.board, w.is.brake));
  }
  shafts_.drive(robot);
}

void EmulatedMachine::pass(std::int64_t dt_ns) noexcept {
  for (EmulatedBoard& board : boards_) board.pass(dt_ns);
}

void EmulatedMachine::switch_power(std::size_t board) noexcept {
  boards_[board].switch_power();
  wires_[board].responder.switch_power();
  wires_[board].drop_replies();
}

void EmulatedMachine::switch_power() noexcept {
  for (std::size_t i = 0; i < boards_.size(); ++i) switch_power(i);
  for (const Wired& w : wired_) {
    // Its joint is put back to the jig before its power comes on.
    if (w.is.home == Home::power_on) boards_[w.board].restore_origin(w.is.encoder);
  }
  shafts_.rest();
  looked_ = false;
}

void EmulatedMachine::check(const EmulatedFault& fault) const {
  check_fault(fault, board_faults, shafts_.drives(), names_);
}

void EmulatedMachine::befall(const EmulatedFault& fault, bool begins) noexcept {
  if (fault.kind == "emergency_button") return press_emergency(begins);
  if (fault.kind == "drive_tripped") return fail_amplifier(shafts_.place(fault.of), begins);
  const double share = begins ? fault.size : 0;
  for (std::size_t i = 0; i < boards_.size(); ++i) {
    if (!fault.of.empty() && fault.of != names_[i]) continue;
    if (fault.kind == "datagrams_lost") wires_[i].faults.lost = share;
    if (fault.kind == "datagrams_corrupt") wires_[i].faults.corrupt = share;
    if (fault.kind == "datagrams_twice") wires_[i].faults.duplicated = share;
    if (fault.kind == "datagrams_late") wires_[i].faults.late = share;
    if (fault.kind == "cable_out") wires_[i].pulled = begins;
    if (!begins) continue;
    if (fault.kind == "watchdog_bites") boards_[i].bite();
    if (fault.kind == "board_reboots") switch_power(i);
  }
}

bool EmulatedMachine::any_torque() const noexcept {
  return std::ranges::any_of(wired_, [&](const Wired& w) { return boards_[w.board].watching() && enabled(w.joint); });
}

bool EmulatedMachine::any_watchdog_tripped() const noexcept {
  return std::ranges::any_of(boards_, [](const EmulatedBoard& board) { return board.bitten(); });
}

}  // namespace kadans::hostmot2
