#include "kadans/plant/bullet/bullet_world.h"

#include <algorithm>
#include <stdexcept>
#include <string>

#include "bullet_robot.h"
#include "convert.h"
#include "plant/bullet/contact/robot_contacts.h"
#include "plant/bullet/contact/room.h"
#include "plant_settings_check.h"
#include "signal/number_text.h"

namespace kadans {

using namespace bullet;

namespace {

// Each robot's own settings in the world of the first.
std::vector<PlantSettings> settings_of(std::span<const WorldSite> robots) {
  if (robots.empty()) throw std::invalid_argument("a world without a robot");
  const PlantSettings& first = robots.front().settings;
  if (robots.size() > 1 && first.solver != ContactSolver::tree)
    throw std::invalid_argument("several robots in one world need the tree solver");
  std::vector<PlantSettings> all;
  for (const WorldSite& robot : robots) {
    PlantSettings& own = all.emplace_back(robot.settings);
    own.gravity_m_s2 = first.gravity_m_s2;
    own.ground_friction = first.ground_friction;
    own.ground_restitution = first.ground_restitution;
    own.ground_stiffness_N_per_m = first.ground_stiffness_N_per_m;
    own.ground_damping_Ns_per_m = first.ground_damping_Ns_per_m;
    own.solver = first.solver;
    own.solver_iterations = first.solver_iterations;
    own.world = first.world;
    own.world.payloads = robot.settings.world.payloads;
    check_settings(robot.model, own);
    robot.model.lead_mimics(own.position_rad);
  }
  return all;
}

}  // namespace

class BulletWorld::Inside {
 public:
  Inside(std::span<const WorldSite> sites, FrictionLaw friction) : settings_(settings_of(sites)) {
    for (std::size_t i = 0; i < sites.size(); ++i) {
      robots_.push_back(std::make_unique<BulletRobot>(sites[i], settings_[i], friction, objects_, i == 0));
      worlds_.push_back(&robots_.back()->world());
    }
    for (const auto& robot : robots_) robot->stand_among(worlds_);
    check_starts(sites);
    if (robots_.size() > 1) contacts_ = std::make_unique<RobotContacts>(worlds_);
  }

  void step(std::int64_t dt_ns) {
    if (dt_ns <= 0) return;
    const double dt_s = static_cast<double>(dt_ns) * 1e-9;
    for (const auto& robot : robots_) robot->begin_step(dt_ns);
    objects_.begin_step(worlds_, time_s());
    if (contacts_ == nullptr) {
      worlds_.front()->step(dt_s);
    } else {
      contacts_->step(dt_s);
    }
    for (const auto& robot : robots_) robot->end_step(dt_s);
    check_objects();
    time_ns_ += dt_ns;
    objects_.end_step(*worlds_.front(), time_s());
    for (const auto& robot : robots_) robot->sample(dt_ns);
  }

  void hash(StateHash& hash) const noexcept {
    for (const auto& robot : robots_) robot->hash_body(hash);
    objects_.hash(hash);
    for (const auto& robot : robots_) robot->hash_contacts(hash);
    for (const auto& robot : robots_) robot->hash_sensors(hash);
  }

  void put(std::size_t object, const Vec3& position_m) { objects_.put(object, to_bullet(position_m), worlds_); }

  std::size_t size() const noexcept { return robots_.size(); }
  BulletRobot& robot(std::size_t number) const noexcept { return *robots_[number]; }

 private:
  double time_s() const { return static_cast<double>(time_ns_) * 1e-9; }

  std::string name_of(const btMultiBodyLinkCollider& link, std::span<const WorldSite> sites) const {
    const auto of = [&](const auto& robot) { return &robot->multibody() == link.m_multiBody; };
    const auto number = static_cast<std::size_t>(std::ranges::find_if(robots_, of) - robots_.begin());
    const std::string name = "link '" + sites[number].model.links[model_link(link.m_link)].name + "'";
    return sites.size() == 1 ? name : name + " of robot " + std::to_string(number + 1);
  }

  // Throws std::invalid_argument when a robot starts deep in another one or in an object.
  void check_starts(std::span<const WorldSite> sites) const {
    const Deepest deepest = deepest_in_others(worlds_);
    if (!(deepest.depth_m > start_depth_max_m)) return;
    const int object = deepest.other->getUserIndex();
    const std::string other =
        object < 0 ? name_of(static_cast<const btMultiBodyLinkCollider&>(*deepest.other), sites)
                   : "the world's '" + settings_.front().world.objects[static_cast<std::size_t>(object)].name + "'";
    throw std::invalid_argument("start: " + name_of(*deepest.link, sites) + " is " +
                                printed("%.0f", 1000 * deepest.depth_m) + " mm deep in " + other +
                                "; start elsewhere (start.x_m, start.y_m)");
  }

  void check_objects() const {
    for (std::size_t i = 0; i < objects_.size(); ++i) {
      if (objects_.finite(i)) continue;
      throw std::runtime_error("the model's state is not finite: '" + settings_.front().world.objects[i].name + "'");
    }
  }

  std::vector<PlantSettings> settings_;  // of each robot
  WorldObjects objects_{settings_.front().world};
  std::vector<std::unique_ptr<BulletRobot>> robots_;  // they let go of the objects before these end
  std::vector<ContactWorld*> worlds_;
  std::unique_ptr<RobotContacts> contacts_;  // of several robots
  std::int64_t time_ns_ = 0;
};

std::vector<std::pair<std::string, std::string>> touching_links(const RobotModel& model, const PlantSettings& settings,
                                                                TouchingAt at) {
  check_settings(model, settings);
  bullet::Body body(model, settings);
  const bool zero = at == TouchingAt::zero;
  bullet::PairMask mask =
      zero ? bullet::known_pair_mask(model, settings) : bullet::make_pair_mask(model, settings, body);
  const std::vector<double> zeros(model.joints.size());
  std::vector<std::pair<std::string, std::string>> names;
  for (const auto& [a, b] : bullet::touching_pairs(body, zero ? zeros : settings.position_rad, mask))
    names.emplace_back(model.links[a].name, model.links[b].name);
  return names;
}

BulletWorld::BulletWorld(const RobotModel& model, const PlantSettings& settings, std::uint64_t seed)
    : BulletWorld(model, settings, seed, FrictionLaw::cone) {}

BulletWorld::BulletWorld(const RobotModel& model, const PlantSettings& settings, std::uint64_t seed,
                         FrictionLaw friction) {
  const WorldSite site{model, settings, seed};
  inside_ = std::make_unique<Inside>(std::span(&site, 1), friction);
}

BulletWorld::BulletWorld(std::span<const WorldSite> robots)
    : inside_(std::make_unique<Inside>(robots, FrictionLaw::cone)) {}

BulletWorld::~BulletWorld() = default;

std::size_t BulletWorld::robot_count() const noexcept { return inside_->size(); }

WorldRobot& BulletWorld::robot(std::size_t number) noexcept { return inside_->robot(number); }

void BulletWorld::step(std::int64_t dt_ns) { inside_->step(dt_ns); }

void BulletWorld::put(std::size_t object, const Vec3& position_m) { inside_->put(object, position_m); }

void BulletWorld::hash(StateHash& hash) const noexcept { inside_->hash(hash); }

void BulletWorld::read(SensorFrame& sensors) noexcept { inside_->robot(0).read(sensors); }

void BulletWorld::write(const ActuationFrame& actuation) noexcept { inside_->robot(0).write(actuation); }

void BulletWorld::write_drives(const ActuationFrame& drives) noexcept { inside_->robot(0).write_drives(drives); }

const PlantTruth& BulletWorld::truth() const noexcept { return inside_->robot(0).truth(); }

void BulletWorld::push(std::size_t link, const Vec3& force_N, const Vec3& point_in_link_m) {
  inside_->robot(0).push(link, force_N, point_in_link_m);
}

void BulletWorld::carry(double x_m, double y_m, double heading_rad) { inside_->robot(0).carry(x_m, y_m, heading_rad); }

}  // namespace kadans
