// A robot on its bench on virtual time: Bullet's model behind emulated boards or servos that are wired as one file
// says, driven as another one says; and a person who sees the joints move.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>
#include <functional>
#include <map>
#include <set>

#include <doctest/doctest.h>
#include <nlohmann/json.hpp>

#include "app/commission/commission.h"
#include "plant/dynamixel_world.h"
#include "plant/hostmot2_world.h"
#include "plant/json_plant_fields.h"
#include "program.h"

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
};

// What happened on all benches of a test.
struct Seen {
  double away_rad = 0;      // of any joint from where it is with the drives off
  double torque_share = 0;  // most of any motor's torque
  int sessions = 0;
};

class VirtualBench final : public Bench {
 public:
  VirtualBench(const Robot& robot, const Truth& truth, Seen& seen)
      : model_(robot.config.model),
        plant_(robot.config.plant),
        period_ns_(robot.config.engine.control_period_ns()),
        seen_(seen) {
    ++seen.sessions;
    if (truth.model) truth.model(plant_);
    const PlantTypes types = plant_types();
    const PlantSite site = plant_site(robot.config, "");
    free_ = plant_type(types, "bullet").make_world({model_, plant_, 1});
    auto model = plant_type(types, "bullet").make_world({model_, plant_, 1});
    if (truth.type == "hm2-eth") {
      const auto settings = wiring_in<hostmot2::HostMot2Settings>(robot.config.file, "hm2-eth");
      auto there = wiring_in<hostmot2::HostMot2Settings>(truth.robot, "hm2-eth");
      if (truth.boards) truth.boards(there);
      auto machine = std::make_unique<test::HostMot2World>(std::move(model), settings, there, site);
      machine->start();
      world_ = std::move(machine);
    } else {
      const auto settings = wiring_in<dynamixel::DynamixelSettings>(robot.config.file, "dynamixel");
      const auto there = wiring_in<dynamixel::DynamixelSettings>(truth.robot, "dynamixel");
      auto servos = std::make_unique<test::DynamixelWorld>(std::move(model), settings, site, &there);
      if (truth.servos) truth.servos(servos->servos());
      servos->start();
      world_ = std::move(servos);
    }
    ActuationFrame off;
    off.joint_count = static_cast<std::uint32_t>(model_.joints.size());
    free_->robot(0).write(off);
  }

  void read(SensorFrame& sensors) override { world_->read(sensors); }
  void write(const ActuationFrame& actuation) override {
    world_->write(actuation);
    world_->step(period_ns_);
    free_->step(period_ns_);
    now_ns_ += period_ns_;
    for (std::size_t i = 0; i < model_.joints.size(); ++i) {
      const double away_rad = std::abs(world_->truth().position_rad[i] - free_->robot(0).truth().position_rad[i]);
      seen_.away_rad = std::max(seen_.away_rad, away_rad);
      if (model_.joints[i].passive()) continue;
      const double share = std::abs(world_->truth().motor_torque_Nm[i]) / model_.joints[i].effort_max_Nm;
      seen_.torque_share = std::max(seen_.torque_share, share);
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
  const PlantTruth& truth() const noexcept { return world_->truth(); }
  const RobotModel& model() const noexcept { return model_; }

 private:
  const RobotModel& model_;
  PlantSettings plant_;
  std::int64_t period_ns_, now_ns_ = 0;
  Seen& seen_;
  std::unique_ptr<World> free_;  // the same with all drives off
  std::unique_ptr<OneRobotWorld> world_;
};

// Looks at the joints while it holds the key, and answers what it saw. It goes after `patience` answers.
class SeeingPerson final : public Person {
 public:
  VirtualBench* bench = nullptr;
  int patience = 1000;
  std::vector<std::string> heard;
  std::map<std::string, std::string> says;  // answers to other questions, by joint

  void hear(const std::string& sentence) override { heard.push_back(sentence); }
  void ask(const Question& question) override {
    asked_ = question;
    ticks_ = 0;
  }
  void ask_to_hold(const Question& question) override {
    heard.push_back(question.text);
    asked_ = question;
    from_ = bench->truth().position_rad;
    least_ = most_ = from_;
  }
  std::optional<std::string> answer(std::int64_t) override {
    const std::size_t of = asked_.joint.empty() ? 0 : *bench->model().find_joint(asked_.joint);
    if (asked_.about == Question::About::ready && ++ticks_ < 3000) {  // to one end and to the other
      bench->turn_by_hand(of, ticks_ < 1500 ? 0.15 : -0.15);
      return std::nullopt;
    }
    --patience;
    if (asked_.about == Question::About::ready) return "done";
    if (asked_.about == Question::About::number)
      return std::to_string(bench->truth().position_rad[of] * 180 / 3.14159265358979);
    if (asked_.about == Question::About::which_joint) return moved();
    if (asked_.about == Question::About::positive) {
      const std::size_t joint = *bench->model().find_joint(asked_.joint);
      return most_[joint] - from_[joint] > from_[joint] - least_[joint] ? "yes" : "no";
    }
    return says.contains(asked_.joint) ? says.at(asked_.joint) : "right";
  }
  Hand hand(std::int64_t, bool complete) override {
    const auto& now = bench->truth().position_rad;
    for (std::size_t i = 0; i < now.size(); ++i) {
      least_[i] = std::min(least_[i], now[i]);
      most_[i] = std::max(most_[i], now[i]);
    }
    return complete ? Hand::done : Hand::holds;
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
      most = bench->model().joints[i].name;
    }
    return most;
  }

  Question asked_;
  std::array<double, max_joints> from_{}, least_{}, most_{};
  int ticks_ = 0;
};

struct Commissioned {
  CommissionReport report;
  SeeingPerson person;
  Seen seen;
};

inline void go(Commissioned& all, const CommissionSettings& settings, const Truth& truth) {
  const OpenDrives open = [&](const Robot& robot) -> OpenBench {
    auto bench = std::make_unique<VirtualBench>(robot, truth, all.seen);
    all.person.bench = bench.get();
    return {std::move(bench), nullptr};
  };
  all.report = commission(settings, all.person, open);
}

}  // namespace kadans::commission_bench
