// Quantities: the named numbers that may be set or drawn for a run. They are the plant's physics, its sensors, its
// start, and the parameters of the control objects.
//
//   ground.friction, restitution, stiffness_N_per_m, damping_Ns_per_m
//   world.<object>.x_m, y_m, friction; of a ball also mass_kg, rolling_friction_m, restitution
//                                        joint.<joint>.torque_scale, damping_scale, coulomb_scale, spring_scale
//   link.<link>.mass_scale, friction     joint.<joint>.coulomb_Nm, start_rad (added), encoder_noise_rad
//   start.x_m, y_m, roll_rad, pitch_rad, yaw_rad
//                                        imu.gyro_noise_rad_s, gyro_bias_rad_s, accelerometer_noise_m_s2, ...
//   sensor.<name>.value, noise
//   foot.<link>.noise_N                  control.<object>.<parameter>, and <parameter>_scale
//   sight.rate_Hz, latency_s, ...        of simulated perception
//   actuation.delay_s                    delay from the control engine's write to the drives' reaction
//
// A quantity of the plant changes the plant alone, never the control side's model of it: the controller does not know
// that a link is heavier. Names may be patterns ("joint.*_knee.torque_scale"). Use this before the run, not in the
// tick.
#pragma once

#include <array>
#include <functional>
#include <string>
#include <vector>

#include "config/scenario/distribution.h"
#include "config/scenario/scenario_config.h"
#include "kadans/control/catalog.h"
#include "kadans/plant/settings.h"

namespace kadans {

// The full name of a quantity and the value that it got.
struct QuantityValue {
  std::string name;
  double value = 0;
};
// In place of the value that it had, or as the last one.
void put_value(std::vector<QuantityValue>& values, const std::string& name, double value);

// The robot as this run's plant simulates it.
struct PlantVariant {
  RobotModel model;
  PlantSettings plant;
  double actuation_delay_s = 0;
  bool sees = false;  // it has simulated perception
  SightSettings sight;
  std::vector<ScenarioPerception> perception{};
};

class Quantities {
 public:
  // Keeps references. A quantity that is set again replaces the earlier value: a scale always multiplies the value that
  // the constructor found. The ground is the first robot's: a further robot of its world has no quantity of it.
  Quantities(PlantVariant& variant, Catalog& catalog, bool further_robot = false);
  Quantities(const Quantities&) = delete;
  Quantities& operator=(const Quantities&) = delete;

  // Full names, in a fixed order.
  const std::vector<std::string>& names() const noexcept { return names_; }
  // What a quantity may be, and what it is now: 1 for a factor that nobody set.
  const NumberRange& range(std::size_t index) const noexcept { return quantities_[index].range; }
  double value(std::size_t index) const noexcept { return quantities_[index].value; }

  // Sets all quantities that the entry's pattern chooses, and adds them to `done`. Adds a problem when the pattern
  // chooses nothing or the value is out of range.
  void set(const NumberEntry& entry, std::vector<QuantityValue>& done, Problems& problems);
  // Draws values for the quantities that the variation's pattern chooses. Each name has a random stream of its own, so
  // its value does not depend on what else varies in the run.
  void draw(const Variation& variation, std::uint64_t seed, std::vector<QuantityValue>& done, Problems& problems);

 private:
  struct Quantity {
    NumberRange range;
    double value = 0;
    std::function<void(double)> set;
  };
  void add(std::string name, NumberRange range, double value, std::function<void(double)> set);
  void add_value(std::string name, NumberRange range, double& value);
  void add_scale(std::string name, double& value);
  void add_joints(const RobotModel& model, PlantSettings& plant);
  void add_links(RobotModel& model, PlantSettings& plant);
  void add_sensors(PlantSettings& plant);
  void add_start(PlantSettings& plant);
  void add_world(PlantSettings& plant);
  void add_parameters(Catalog& catalog);
  std::vector<std::size_t> chosen(const std::string& pattern, TextPlace place, Problems& problems) const;
  bool apply(std::size_t index, double value, TextPlace place, std::vector<QuantityValue>& done, Problems& problems);

  std::vector<std::string> names_;
  std::vector<Quantity> quantities_;
  std::array<double, 3> turn_rad_{};  // of the start pose: roll, pitch, yaw
};

}  // namespace kadans
