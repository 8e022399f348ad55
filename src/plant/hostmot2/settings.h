// Which modules of which boards move which joints: the fields under plant.hm2-eth of the robot's configuration.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "amplifier.h"
#include "kadans/plant/plant_type.h"
#include "kadans/signal/capacity.h"

namespace kadans::hostmot2 {

// A pin of a board; "!7": active where it is low.
struct PinSettings {
  std::uint32_t number = 0;
  bool low = false;
  InputProblem place{};  // in the configuration, for what only the board shows
};
using OptionalPin = std::optional<PinSettings>;

struct BoardSettings {
  std::string name;
  std::string address;   // "192.168.1.121" or with ":PORT"
  std::string resource;  // or the file of a PCI card's registers
  std::string card;      // what it calls itself: "7I96"
  double pwm_Hz = 20'000;
  InputProblem place{};

  const std::string& where() const noexcept { return resource.empty() ? address : resource; }
};

enum class PwmOutput : std::uint8_t { pwm_dir = 0, dir_pwm = 1, up_down = 2, pdm = 3 };
// How a joint's position gets its zero.
enum class Home : std::uint8_t { power_on, index, probe, home_switch };

struct DriveWiring {
  std::string drive;  // as plant.drives has it: the joint's, or that of a coupling
  std::string board;
  std::uint32_t encoder = 0;
  std::optional<std::uint32_t> pwm{};  // none: a joint that is only measured
  PwmOutput output = PwmOutput::pwm_dir;
  double counts_per_rad = 0;
  bool reversed = false;      // the encoder counts in the opposite direction
  bool pwm_reversed = false;  // so does the motor
  AmplifierSettings amplifier{};
  double position_gain_Nm_per_rad = 0, velocity_gain_Nms_per_rad = 0;  // of position and velocity modes
  double velocity_max_rad_s = 100;                                     // no reading is faster than this
  double spring_Nm_per_rad = 0;  // between its motor and the encoder, which sits at the joint; 0: none
  Home home = Home::power_on;
  double home_rad = 0;      // where it is at its zero
  double home_rad_s = 0.1;  // how fast, and in which direction, it looks for it
  double home_timeout_s = 30;
  OptionalPin enable{}, fault{}, brake{}, low{}, high{}, home_switch{};
  InputProblem encoder_place{}, pwm_place{};
};

// Switches under the corners of a sole.
struct FootWiring {
  std::string foot;
  std::string board;
  std::array<OptionalPin, sensors_per_foot> corners{};  // in the order of FootSample
  double closed_N = 10;                                 // what a closed one stands for
};

struct InputWiring {
  std::string name;  // of the robot's sensor
  std::string board;
  OptionalPin pin{};
};

struct HostMot2Settings {
  std::vector<BoardSettings> boards;
  std::vector<DriveWiring> drives;
  std::vector<FootWiring> feet;
  std::vector<InputWiring> inputs;
  std::string emergency_board;
  OptionalPin emergency{};
  double period_s = 0;  // of the bus; 0: the control period
  double watchdog_s = 0.01;
  double reply_wait_s = 0.0002;
  double patience_s = 0.05;

  // Lists the fields; refuses what does not fit together.
  void fields(PlantFields& f);
  // The board's place in `boards`; their number where none has the name.
  std::size_t board_number(const std::string& name) const noexcept;
  // The boards are asked in every so many control ticks.
  std::uint32_t bus_divisor(std::int64_t control_period_ns) const noexcept;
  // The same boards, at this address and those that follow it.
  void move_boards(const std::string& first_address);
  // Throws InputError where one is no board on Ethernet: those alone have emulators.
  void require_ethernet() const;
};

inline constexpr std::uint16_t lbp_udp_port = 27181;
// "192.168.1.121" as "192.168.1.121:27181". Throws InputError where it is none.
std::string board_place(const std::string& address);

// Whether this machine has a network card in the network of a board on Ethernet, and what else helps or hinders boards
// (network_check.cpp). Nothing is sent.
PlantType::Finding examine_card(const BoardSettings& board);
std::vector<PlantType::Finding> examine_boards(const HostMot2Settings& settings, std::int64_t control_period_ns);

}  // namespace kadans::hostmot2
