#include "settings.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>

#include "kadans/signal/nearest_name.h"
#include "signal/input_file.h"
#include "signal/number_text.h"

namespace kadans::hostmot2 {
namespace {

constexpr std::uint32_t no_instance = 255, instances_max = 31, pins_max = 143;

constexpr std::array<const char*, 4> output_names{"pwm_dir", "dir_pwm", "up_down", "pdm"};
constexpr std::array<const char*, 4> home_names{"power_on", "index", "probe", "switch"};
constexpr std::array<const char*, 3> amplifier_names{"current", "voltage", "velocity"};

// A word among several.
template <typename T, std::size_t N>
void choice(PlantFields& f, std::string_view name, T& value, const std::array<const char*, N>& names,
            const std::string& doc) {
  const std::string one_of = listed(names, {}, ", ", " or ");
  std::string word = names[static_cast<std::size_t>(value)];
  f.string(name, word, doc + ": " + one_of);
  if (!f.reading()) return;
  const auto found = std::ranges::find(names, word);
  if (found == names.end()) return f.refuse(name, "'" + word + "' must be " + one_of);
  value = static_cast<T>(found - names.begin());
}

void pin(PlantFields& f, std::string_view name, OptionalPin& value, const std::string& doc) {
  std::string text;
  f.string(name, text, doc + R"(: "7" is pin 7, "!7" where it is active when it is low)");
  if (!f.reading() || text.empty()) return;
  PinSettings is{.low = text.front() == '!', .place = f.place(name)};
  const auto number = number_of<std::uint32_t>(text.substr(is.low ? 1 : 0));
  if (!number || *number > pins_max)
    return f.refuse(name, "'" + text + R"(' is no pin: a number of 0..143, such as "7", or "!7")");
  is.number = *number;
  value = is;
}

// Who uses what of the boards; the second one is refused.
class Uses {
 public:
  void take(PlantFields& f, std::string_view field, const std::string& board, const std::string& what,
            const std::string& who) {
    const auto same = [&](const Use& one) { return one.board == board && one.what == what; };
    const auto found = std::ranges::find_if(uses_, same);
    if (found != uses_.end()) return f.refuse(field, what + " of board '" + board + "' is already " + found->who);
    uses_.push_back({board, what, who});
  }
  void take(PlantFields& f, std::string_view field, const std::string& board, const OptionalPin& is,
            const std::string& who) {
    if (is) take(f, field, board, "pin " + std::to_string(is->number), who);
  }

 private:
  struct Use {
    std::string board, what, who;
  };
  std::vector<Use> uses_;
};

class Reader {
 public:
  Reader(HostMot2Settings& settings, PlantFields& all) : settings_(settings), all_(all) {}

  void board(PlantFields& f, const std::string& key) {
    BoardSettings is{.name = key, .place = f.place("")};
    f.string("address", is.address, "its address, such as 192.168.1.121");
    f.string("resource", is.resource,
             "of a PCI card instead: the file of its registers, /sys/bus/pci/devices/*/resource3");
    f.string("board", is.card, "what it is, as it names itself: 7I96, 7I92, 7I76E-16, 5I20");
    f.number("pwm_Hz", is.pwm_Hz, {100, 200'000, "Hz"}, "frequency of its PWMs");
    if (!f.reading()) return;
    if (!is_word(key)) f.refuse("", "'" + key + "' is no name for a board: letters, digits and '_'");
    if (is.card.empty()) f.refuse("", "board '" + key + "' does not say what it is, such as \"board\": \"7I96\"");
    if (!is.resource.empty()) {
      if (!is.address.empty()) f.refuse("resource", "a board has an address or a resource, not both");
      settings_.boards.push_back(is);
      return;
    }
    try {
      (void)board_place(is.address);
      for (const BoardSettings& other : settings_.boards) {
        if (other.resource.empty() && board_place(other.address) == board_place(is.address))
          f.refuse("address", "board '" + other.name + "' already has the address " + is.address);
      }
    } catch (const InputError& error) {
      f.refuse("address", error.problems().front().message);
      is.address = "0.0.0.0";
    }
    settings_.boards.push_back(is);
  }

  void drive(PlantFields& f, const std::string& key) {
    DriveWiring is{.drive = key, .encoder = no_instance};
    std::uint32_t pwm = no_instance;
    its_board(f, is.board);
    f.integer("encoder", is.encoder, {0, instances_max, ""}, "number of its encoder");
    f.integer("pwm", pwm, {0, instances_max, ""}, "number of its PWM generator; none: it is only measured");
    choice(f, "output", is.output, output_names, "how its amplifier takes the PWM");
    f.number("counts_per_rad", is.counts_per_rad, {-1e7, 1e7, "1/rad"},
             "counts of its encoder for a radian of the drive");
    f.boolean("reversed", is.reversed, "its encoder counts in the opposite direction");
    f.boolean("pwm_reversed", is.pwm_reversed, "its motor turns in the opposite direction");
    amplifier(f, is.amplifier);
    f.number("position_gain_Nm_per_rad", is.position_gain_Nm_per_rad, {0, 1e5, "Nm/rad"},
             "of the position mode, whose loop is closed here");
    f.number("velocity_gain_Nms_per_rad", is.velocity_gain_Nms_per_rad, {0, 1e4, "Nms/rad"},
             "of the position and velocity modes; of a velocity amplifier the gain of its own loop");
    f.number("velocity_max_rad_s", is.velocity_max_rad_s, {0.01, 1e4, "rad/s"}, "a faster reading is not believed");
    f.number("spring_Nm_per_rad", is.spring_Nm_per_rad, {0, 1e6, "Nm/rad"},
             "of a spring between its motor and its encoder, which then sits at the joint; 0: none");
    choice(f, "home", is.home, home_names, "what tells its zero");
    f.number("home_rad", is.home_rad, {-1e3, 1e3, "rad"}, "where it is there");
    f.number("home_rad_s", is.home_rad_s, {-10, 10, "rad/s"},
             "how fast it looks for its zero; the sign is the direction");
    f.number("home_timeout_s", is.home_timeout_s, {0.1, 1000, "s"}, "how long it looks for it");
    pins(f, is);
    if (!f.reading()) return;
    is.encoder_place = f.place("encoder");
    is.pwm_place = f.place("pwm");
    if (pwm != no_instance) is.pwm = pwm;
    const bool by_velocity = is.amplifier.kind == AmplifierSettings::Kind::velocity;
    if (by_velocity && !(is.velocity_gain_Nms_per_rad > 0))
      f.refuse("velocity_gain_Nms_per_rad",
               "a velocity amplifier needs the gain of its own loop: Nm at the drive by rad/s");
    if (by_velocity) is.amplifier.gain_Nms_per_rad = is.velocity_gain_Nms_per_rad;
    check_drive(f, is);
    settings_.drives.push_back(is);
  }

  void foot(PlantFields& f, const std::string& key) {
    FootWiring is{.foot = key};
    its_board(f, is.board);
    constexpr std::array<const char*, sensors_per_foot> corners{"heel_inner", "heel_outer", "toe_inner", "toe_outer"};
    for (std::size_t i = 0; i < corners.size(); ++i) pin(f, corners[i], is.corners[i], "the switch there");
    f.number("closed_N", is.closed_N, {0.1, 1e4, "N"}, "force that a closed switch stands for");
    if (!f.reading()) return;
    for (std::size_t i = 0; i < corners.size(); ++i)
      uses_.take(f, corners[i], is.board, is.corners[i], "of foot '" + key + "'");
    settings_.feet.push_back(is);
  }

  void input(PlantFields& f, const std::string& key) {
    InputWiring is{.name = key};
    its_board(f, is.board);
    pin(f, "pin", is.pin, "the pin that it reads");
    if (!f.reading()) return;
    if (!is.pin) return f.refuse("", "input '" + key + "' names no pin");
    uses_.take(f, "pin", is.board, is.pin, "the input '" + key + "'");
    settings_.inputs.push_back(is);
  }

  void emergency(PlantFields& f, const std::string&) {
    its_board(f, settings_.emergency_board);
    pin(f, "pin", settings_.emergency, "active while the emergency stop is pressed");
    if (f.reading()) uses_.take(f, "pin", settings_.emergency_board, settings_.emergency, "the emergency stop's");
  }

 private:
  void its_board(PlantFields& f, std::string& name) {
    if (f.reading() && settings_.boards.size() == 1) name = settings_.boards[0].name;
    f.string("board", name, "its board (default: the only one)");
    if (!f.reading() || settings_.board_number(name) < settings_.boards.size()) return;
    f.refuse("board", name.empty() ? "names no board, and there are several"
                                   : "no board '" + name + "' in plant.hm2-eth.boards");
  }

  static void amplifier(PlantFields& f, AmplifierSettings& is) {
    choice(f, "amplifier", is.kind, amplifier_names, "what the duty of its PWM is for its amplifier");
    is.current_max_A = 0;
    f.number("amplifier_full", is.full, {1e-3, 1e4, ""}, "amperes, volts, or rad/s of the motor, at full duty");
    f.number("current_max_A", is.current_max_A, {0, 1e4, "A"},
             "most that the motor gets; 0: what an amplifier of current or voltage has");
    f.number("winding_Ohm", is.winding_Ohm, {1e-3, 1e4, "Ohm"}, "of the motor, for an amplifier of voltage");
    f.number("Nm_per_A", is.Nm_per_A, {1e-6, 1e3, "Nm/A"}, "torque constant of the motor");
    f.number("gear", is.gear, {1e-3, 1e5, ""}, "turns of the motor for one of the drive");
    f.number("efficiency", is.efficiency, {0.01, 1, ""}, "of the gear");
    if (f.reading() && is.kind == AmplifierSettings::Kind::velocity && is.current_max_A == 0)
      f.refuse("current_max_A", "a velocity amplifier's duty says nothing of it: name what its motor gets at most");
    if (is.current_max_A == 0)
      is.current_max_A = is.kind == AmplifierSettings::Kind::voltage ? is.full / is.winding_Ohm : is.full;
  }

  static void pins(PlantFields& f, DriveWiring& is) {
    pin(f, "enable", is.enable, "output that enables its amplifier");
    pin(f, "brake", is.brake, "output that opens its brake");
    pin(f, "fault", is.fault, "input, active when its amplifier has a fault");
    pin(f, "low", is.low, "input of the limit switch at its low end");
    pin(f, "high", is.high, "input of the limit switch at its high end");
    pin(f, "home_switch", is.home_switch, "input of the switch at its zero");
  }

  void check_drive(PlantFields& f, const DriveWiring& is) {
    const std::span<const std::string> drives = all_.drives();
    if (!drives.empty() && std::ranges::find(drives, is.drive) == drives.end())
      f.refuse("", "no drive '" + is.drive + "'" +
                       did_you_mean(is.drive, std::vector<std::string>(drives.begin(), drives.end())));
    const std::string whose = "of drive '" + is.drive + "'";
    if (is.encoder > instances_max) {
      f.refuse("", "drive '" + is.drive + "' names no encoder");
    } else {
      uses_.take(f, "encoder", is.board, "encoder " + std::to_string(is.encoder), "that " + whose);
    }
    if (is.pwm) uses_.take(f, "pwm", is.board, "pwm " + std::to_string(*is.pwm), "that " + whose);
    if (is.counts_per_rad < 0)
      f.refuse("counts_per_rad",
               "must be above 0; an encoder that counts in the opposite direction is \"reversed\": true");
    if (is.counts_per_rad == 0)
      f.refuse("counts_per_rad", "drive '" + is.drive + "' does not say how its encoder counts");
    if (is.home_rad_s == 0 && is.home != Home::power_on)
      f.refuse("home_rad_s", "must not be 0: it would look for its zero for ever");
    if (is.home == Home::home_switch && !is.home_switch) f.refuse("home", "\"switch\" needs the pin of a home_switch");
    if (!is.pwm && (is.enable || is.brake || is.fault || is.home != Home::power_on))
      f.refuse("", "drive '" + is.drive + "' has no pwm: it cannot be enabled, braked or homed");
    uses_.take(f, "enable", is.board, is.enable, "an output " + whose);
    uses_.take(f, "brake", is.board, is.brake, "an output " + whose);
    uses_.take(f, "fault", is.board, is.fault, "an input " + whose);
    uses_.take(f, "low", is.board, is.low, "an input " + whose);
    uses_.take(f, "high", is.board, is.high, "an input " + whose);
    uses_.take(f, "home_switch", is.board, is.home_switch, "an input " + whose);
  }

  HostMot2Settings& settings_;
  PlantFields& all_;
  Uses uses_;
};

}  // namespace

std::string board_place(const std::string& address) {
  const std::size_t colon = address.find(':');
  const std::string host = address.substr(0, colon);
  const bool digits = !host.empty() && host.find_first_not_of("0123456789.") == std::string::npos;
  if (!digits) refuse("'" + address + "' must be an address such as 192.168.1.121");
  return colon == std::string::npos ? host + ":" + std::to_string(lbp_udp_port) : address;
}

std::size_t HostMot2Settings::board_number(const std::string& name) const noexcept {
  return static_cast<std::size_t>(std::ranges::find(boards, name, &BoardSettings::name) - boards.begin());
}

std::uint32_t HostMot2Settings::bus_divisor(std::int64_t control_period_ns) const noexcept {
  return static_cast<std::uint32_t>(std::max(1L, std::lround(1e9 * period_s / static_cast<double>(control_period_ns))));
}

void HostMot2Settings::require_ethernet() const {
  for (const BoardSettings& board : boards) {
    if (!board.resource.empty()) refuse("board '" + board.name + "' is no board on Ethernet");
  }
}

void HostMot2Settings::move_boards(const std::string& first_address) {
  const std::size_t colon = first_address.find(':');
  const std::string port = colon == std::string::npos ? "" : first_address.substr(colon);
  const std::string host = first_address.substr(0, colon);
  const std::size_t dot = host.rfind('.');
  std::uint32_t last = 0;
  const bool good = dot != std::string::npos && !board_place(first_address).empty() &&
                    std::from_chars(host.data() + dot + 1, host.data() + host.size(), last).ec == std::errc() &&
                    last + boards.size() <= 256;
  if (!good) refuse("'" + first_address + "' must be an address such as 192.168.1.121");
  for (BoardSettings& board : boards) board.address = host.substr(0, dot + 1) + std::to_string(last++) + port;
}

void HostMot2Settings::fields(PlantFields& f) {
  Reader reader(*this, f);
  const auto with = [&](void (Reader::*read)(PlantFields&, const std::string&)) {
    return [&reader, read](PlantFields& entry, const std::string& key) { (reader.*read)(entry, key); };
  };
  f.map("boards", with(&Reader::board), "the boards, by name");
  f.map("drives", with(&Reader::drive),
        "what moves and measures each drive (named as the joints, where no transmission names others)");
  f.map("feet", with(&Reader::foot), "switches under the soles, by the feet's links");
  f.map("inputs", with(&Reader::input), "pins that are the robot's sensors, by their names");
  f.map("emergency", with(&Reader::emergency), "inputs of the emergency stop, by names of your own");
  f.number("period_s", period_s, {0, 1, "s"},
           "period of the bus, a whole multiple of the control period; 0: that period");
  f.number("watchdog_s", watchdog_s, {1e-4, 1, "s"},
           "time without a word after which the boards release their outputs");
  f.number("reply_wait_s", reply_wait_s, {0, 0.01, "s"}, "how long a tick waits for an answer that is not there yet");
  f.number("patience_s", patience_s, {1e-3, 1, "s"}, "time for an answer while boards are found and set up");
  if (!f.reading() || (boards.empty() && drives.empty())) return;
  for (const std::string& drive : f.drives()) {
    if (std::ranges::find(drives, drive, &DriveWiring::drive) == drives.end())
      f.refuse("drives", "drive '" + drive + "' has no encoder and no pwm");
  }
}

}  // namespace kadans::hostmot2
