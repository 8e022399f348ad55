// A robot on its bench on virtual time: Bullet's model behind emulated boards or servos that are wired as one file
// says, driven as another one says; and a person who sees the joints move.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <deque>
#include <fstream>
#include <functional>
#include <map>
#include <optional>
#include <set>

#include <doctest/doctest.h>
#include <nlohmann/json.hpp>

#include "app/assembly/assembled_plant.h"
#include "app/commission/bench_session.h"
#include "app/commission/commission.h"
#include "app/program.h"
#include "plant/dynamixel/emulator/servo_world.h"
#include "plant/hostmot2/emulator/board_world.h"
#include "plant/json_plant_fields.h"

namespace kadans::commission_bench {

template <typename Settings>
Settings wiring_in(const std::string& file, const char* type) {
  std::ifstream in(file);
  const nlohmann::ordered_json json = nlohmann::ordered_json::parse(in, nullptr, true, true);
  Settings settings;
  test::JsonPlantFields fields(json.at("plant").at(type));
  settings.fields(fields);
  return settings;
}

struct Truth {
  std::string type;                                           // hm2-eth or dynamixel
  std::string robot;                                          // the file that says how it is really wired
  std::function<void(hostmot2::HostMot2Settings&)> boards{};  // and what is broken there
  std::function<void(PlantSettings&)> model{};                // and in the model
  std::function<void(dynamixel::EmulatedRobot&)> servos{};
  std::function<void(dynamixel::DynamixelSettings&)> servo_settings{};
  std::size_t delay_ticks = 0;              // from the program to the bus
  int stall_ticks = 0, stall_every = 1000;  // so many of so many: what is on the bus stands still
  double load_kg = 0;                       // what the person hangs on tilt, at load_m from its axis
  double cut_at_share = 0;                  // the cable is out from the first torque of this share; 0: never
};
constexpr double load_m = 0.1;

// A hand at JIWIY's pan or tilt: how much of its strength it has in this tick.
struct HandAt {
  std::size_t joint = 0;
  double place_rad = 0, share = 0;
};

// What happened on all benches of a test.
struct Seen {
  double away_rad = 0;                            // of any joint from where it is with the drives off
  double torque_share = 0;                        // most of any motor's torque
  std::int64_t cut_ns = -1, torque_until_ns = 0;  // when the line was cut, on this bench; its last torque
  int sessions = 0;
};

class VirtualBench final : public Bench {
 public:
  VirtualBench(const Robot& robot, const Truth& truth, Seen& seen)
      : model_(robot.config.model),
        plant_(robot.config.plant),
        period_ns_(robot.config.engine.control_period_ns()),
        truth_(truth),
        seen_(seen) {
    ++seen.sessions;
    seen.cut_ns = -1;
    seen.torque_until_ns = 0;
    if (truth.model) truth.model(plant_);
    const PlantTypes types = plant_types();
    const PlantSite site = plant_site(robot.config, "");
    free_ = plant_type(types, "bullet").make_world({model_, plant_, 1});
    auto model = plant_type(types, "bullet").make_world({model_, plant_, 1});
    if (truth.type == "hm2-eth") {
      const auto settings = wiring_in<hostmot2::HostMot2Settings>(robot.config.file, "hm2-eth");
      auto there = wiring_in<hostmot2::HostMot2Settings>(truth.robot, "hm2-eth");
      if (truth.boards) truth.boards(there);
      auto machine = std::make_unique<hostmot2::BoardWorld>(std::move(model), settings, there, site);
      machine->start();
      drives_ = &machine->machine();
      world_ = std::move(machine);
    } else {
      const auto settings = wiring_in<dynamixel::DynamixelSettings>(robot.config.file, "dynamixel");
      auto there = wiring_in<dynamixel::DynamixelSettings>(truth.robot, "dynamixel");
      if (truth.servo_settings) truth.servo_settings(there);
      auto servos = std::make_unique<dynamixel::ServoWorld>(std::move(model), settings, site, &there);
      if (truth.servos) truth.servos(servos->servos());
      servos->start();
      drives_ = &servos->servos();
      world_ = std::move(servos);
    }
    ActuationFrame off;
    off.joint_count = static_cast<std::uint32_t>(model_.joints.size());
    free_->robot(0).write(off);
  }

  void read(SensorFrame& sensors) override { world_->read(sensors); }
  void write(const ActuationFrame& actuation) override {
    if (++tick_ % truth_.stall_every < truth_.stall_ticks) {
      now_ns_ += period_ns_;
      return;
    }
    late_.push_back(actuation);
    world_->write(late_.front());
    if (late_.size() > truth_.delay_ticks) late_.pop_front();
    if (hand) {
      const double away_rad = truth().position_rad[hand->joint] - hand->place_rad;
      turn_by_hand(hand->joint, -hand->share * (2 * away_rad + 0.1 * truth().velocity_rad_s[hand->joint]));
    }
    if (loaded) world_->push(2, {0, 0, -9.81 * truth_.load_kg}, {load_m, 0, 0});
    world_->step(period_ns_);
    free_->step(period_ns_);
    now_ns_ += period_ns_;
    for (std::size_t i = 0; i < model_.joints.size(); ++i) {
      const bool by_hand = hand && hand->joint == i;
      const double from_rad = by_hand ? hand->place_rad : free_->robot(0).truth().position_rad[i];
      seen_.away_rad = std::max(seen_.away_rad, std::abs(world_->truth().position_rad[i] - from_rad));
      if (model_.joints[i].passive()) continue;
      const double most_Nm =
          model_.coupling_of(i) != nullptr ? plant_.drives[i].torque_max_Nm : model_.joints[i].effort_max_Nm;
      const double share = std::abs(world_->truth().motor_torque_Nm[i]) / most_Nm;
      seen_.torque_share = std::max(seen_.torque_share, share);
      if (share > 0) seen_.torque_until_ns = now_ns_;
      if (truth_.cut_at_share == 0 || share < truth_.cut_at_share || seen_.cut_ns >= 0) continue;
      seen_.cut_ns = now_ns_;
      drives_->befall({.kind = "cable_out", .of = ""}, true);
    }
  }
  std::int64_t now_ns() const noexcept override { return now_ns_; }
  // A hand turns JIWIY's pan or tilt in this tick.
  void turn_by_hand(std::size_t joint, double effort_Nm) {
    const double pan = truth().position_rad[0], tilt = truth().position_rad[1], N = effort_Nm / 0.1;
    const Vec3 level{-std::sin(pan), std::cos(pan), 0};
    const Vec3 down{-std::sin(tilt) * std::cos(pan), -std::sin(tilt) * std::sin(pan), -std::cos(tilt)};
    const Vec3& along = joint == 0 ? level : down;
    world_->push(joint + 1, {N * along[0], N * along[1], N * along[2]}, {0.1, 0, 0});
  }
  std::optional<HandAt> hand;
  bool loaded = false;
  const PlantTruth& truth() const noexcept { return world_->truth(); }
  // Where each drive stands, in its joint's place.
  std::array<double, max_joints> drives_rad() const {
    std::array<double, max_joints> is = truth().position_rad;
    for (const Transmission& pair : model_.transmissions) {
      if (!pair.coupled()) continue;
      const std::size_t a = pair.joints()[0], b = pair.joints()[1];
      const Transmission::Pair at = pair.drive_position_rad({is[a], is[b]});
      is[a] = at[0], is[b] = at[1];
    }
    return is;
  }
  std::string drive_name(std::size_t joint) const {
    return model_.coupling_of(joint) != nullptr ? model_.drive_names()[joint] : model_.joints[joint].name;
  }
  // By the name of a joint, or of one of two drives that move it.
  std::size_t number_of(const std::string& name) const {
    const std::vector<std::string> drives = model_.drive_names();
    return model_.find_joint(name).value_or(static_cast<std::size_t>(std::ranges::find(drives, name) - drives.begin()));
  }
  const RobotModel& model() const noexcept { return model_; }

 private:
  const RobotModel& model_;
  PlantSettings plant_;
  std::int64_t period_ns_, now_ns_ = 0;
  int tick_ = 0;
  const Truth& truth_;
  Seen& seen_;
  std::deque<ActuationFrame> late_;
  std::unique_ptr<World> free_;  // the same with all drives off
  EmulatedDrives* drives_ = nullptr;
  std::unique_ptr<OneRobotWorld> world_;
};

// Looks at the joints while it holds the key, and answers what it saw. It goes after `patience` answers. A joint that
// it has in its hand it lets go slowly when the key is held, and holds again at the end.
class SeeingPerson final : public Person {
 public:
  VirtualBench* bench = nullptr;
  int patience = 1000;
  std::vector<std::string> heard;
  std::map<std::string, std::string> says;     // answers to other questions, by joint
  std::map<std::string, std::string> replies;  // answers to questions with these words
  std::optional<HandAt> hand_at;               // what it holds by hand, wherever that is asked for

  void hear(const std::string& sentence) override { heard.push_back(sentence); }
  void ask(const Question& question) override {
    asked_ = question;
    ticks_ = 0;
  }
  void ask_to_hold(const Question& question) override {
    heard.push_back(question.text);
    asked_ = question;
    from_ = bench->drives_rad();
    least_ = most_ = from_;
    held_ticks_ = complete_ticks_ = 0;
    bench->loaded = question.text.starts_with("Now the same with the load");
  }
  std::optional<std::string> answer(std::int64_t) override {
    const std::size_t of = asked_.joint.empty() ? 0 : bench->number_of(asked_.joint);
    if (asked_.about == Question::About::ready && ++ticks_ < 3000) {  // to one end and to the other
      bench->turn_by_hand(of, ticks_ < 1500 ? 0.15 : -0.15);
      return std::nullopt;
    }
    --patience;
    for (const auto& [words, reply] : replies) {
      if (asked_.text.find(words) != std::string::npos) return reply;
    }
    if (asked_.about == Question::About::ready) return "done";
    if (asked_.about == Question::About::number)
      return std::to_string(bench->truth().position_rad[of] * 180 / 3.14159265358979);
    if (asked_.about == Question::About::which_joint) return moved();
    if (asked_.about == Question::About::positive) {
      return most_[of] - from_[of] > from_[of] - least_[of] ? "yes" : "no";
    }
    return says.contains(asked_.joint) ? says.at(asked_.joint) : "right";
  }
  Hand hand(std::int64_t, bool complete) override {
    const std::array<double, max_joints> now = bench->drives_rad();
    for (std::size_t i = 0; i < bench->model().joints.size(); ++i) {
      least_[i] = std::min(least_[i], now[i]);
      most_[i] = std::max(most_[i], now[i]);
    }
    if (asked_.about != Question::About::load || !hand_at) return complete ? Hand::done : Hand::holds;
    constexpr double from_s = 1, for_s = 1, back_s = 0.3;
    const double passed_s = 1e-3 * ++held_ticks_, over_s = 1e-3 * (complete ? ++complete_ticks_ : 0);
    bench->hand->share =
        complete ? std::min(1.0, over_s / back_s) : std::clamp(1 - (passed_s - from_s) / for_s, 0.0, 1.0);
    if (over_s < back_s + 0.1) return Hand::holds;
    bench->loaded = false;
    return Hand::done;
  }
  bool gone() override { return patience <= 0; }

  bool was_told(std::string_view part) const {
    return std::ranges::any_of(heard, [&](const std::string& one) { return one.find(part) != std::string::npos; });
  }

 private:
  std::string moved() const {
    std::string most = "none";
    double way_rad = 0.002;
    for (std::size_t i = 0; i < bench->model().joints.size(); ++i) {
      if (bench->model().joints[i].passive() || most_[i] - least_[i] < way_rad) continue;
      way_rad = most_[i] - least_[i];
      most = bench->drive_name(i);
    }
    return most;
  }

  Question asked_;
  std::array<double, max_joints> from_{}, least_{}, most_{};
  int ticks_ = 0, held_ticks_ = 0, complete_ticks_ = 0;
};

struct Commissioned {
  CommissionReport report;
  SeeingPerson person;
  Seen seen;
};

inline void go(Commissioned& all, const CommissionSettings& settings, const Truth& truth) {
  const OpenDrives open = [&](const Robot& robot) {
    auto bench = std::make_unique<VirtualBench>(robot, truth, all.seen);
    all.person.bench = bench.get();
    bench->hand = all.person.hand_at;
    return bench;
  };
  all.report = commission(settings, all.person, open);
}

}  // namespace kadans::commission_bench
