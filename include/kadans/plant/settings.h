// What a modelled plant consists of beside the robot's links: drives, sensors, feet, ground, world, solver.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "kadans/model/robot_model.h"
#include "kadans/plant/world_settings.h"
#include "kadans/signal/sensor_channel.h"

namespace kadans {

// A motor with its gear, seen from the joint; one that couples two joints (model/transmission.h) is seen from its own
// side of the coupling, its springs too. With a spring it is a series elastic actuator: the rotor is a state of its own
// and only the spring's torque reaches the joint. Without one the rotor's inertia moves with the joint.
struct DriveSettings {
  double torque_max_Nm = 0;        // 0: passive, no motor
  double velocity_max_rad_s = 0;   // no-load speed: available torque falls linearly ...
  double knee_velocity_rad_s = 0;  // ... from torque_max at this speed to 0 at velocity_max
  double rotor_inertia_kg_m2 = 0;  // reflected to the joint
  double viscous_Nms_per_rad = 0;  // motor-side friction
  double coulomb_Nm = 0;           // motor-side friction
  double spring_Nm_per_rad = 0;    // 0: rigid
  double spring_damping_Nms_per_rad = 0;
  double position_gain_Nm_per_rad = 0;   // of the drive's own position mode, an implicit row
  double velocity_gain_Nms_per_rad = 0;  // of its position and velocity modes
  // A passive spring and damper parallel to the joint, with or without a motor.
  double parallel_spring_Nm_per_rad = 0;
  double parallel_rest_rad = 0;
  double parallel_damping_Nms_per_rad = 0;
  // Its electronics.
  bool enabled = true;  // at the start
  double enable_s = 0;  // from the order until it is enabled
  double brake_Nm = 0;  // holds the joint while the drive is not enabled; 0: there is no brake
};

struct EncoderSettings {
  double resolution_rad = 0;  // 0: continuous
  double noise_rad = 0;       // standard deviation
};

struct ImuSettings {
  Pose pose;                                         // in the base frame
  double gyro_noise_rad_s = 0, gyro_bias_rad_s = 0;  // standard deviations; the bias is drawn once a run
  double accelerometer_noise_m_s2 = 0, accelerometer_bias_m_s2 = 0;
};

// A sole with pressure sensors at its corners.
struct FootSettings {
  std::string link;
  std::array<Vec3, sensors_per_foot> sensors_m{};  // in the link's frame; order as in FootSample
  double noise_N = 0;
};

struct SurfaceSettings {
  std::string link;
  double friction = 0.5;
};

// Of contacts and joint laws: our own, or the one that Bullet brings.
enum class ContactSolver : std::uint8_t { tree, stock };

struct PlantSettings {
  std::vector<DriveSettings> drives;      // one per joint, of coupled joints the drives in their order
  std::vector<EncoderSettings> encoders;  // one per joint
  ImuSettings imu;
  std::vector<FootSettings> feet;
  std::vector<SensorChannel> channels;    // sensors other than joints, IMU and feet
  std::vector<SurfaceSettings> surfaces;  // links not named have friction 0.5
  double ground_friction = 1.0;           // a contact's friction is the product of both
  double ground_restitution = 0;          // of a contact, the greater of both
  // Of a soft ground, such as grass, under each point of contact (a sole has four); 0 N/m: hard.
  double ground_stiffness_N_per_m = 0, ground_damping_Ns_per_m = 0;
  Vec3 gravity_m_s2{0, 0, -9.81};
  ContactSolver solver = ContactSolver::tree;
  int solver_iterations = 10;
  bool fixed_base = false;  // the base link is bolted to the world
  bool self_collision = true;
  std::vector<std::pair<std::string, std::string>> passing;  // links that pass through each other, beside neighbours
  WorldSettings world;
  // Where the robot starts. With stand_on_ground the base's z is chosen so that the lowest collision point touches the
  // ground or the fixed object of the world under it (a fixed base stays where it is put).
  Pose base;
  bool stand_on_ground = true;
  std::vector<double> position_rad;  // one per joint
};

}  // namespace kadans
