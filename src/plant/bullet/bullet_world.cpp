#include "kadans/plant/bullet/bullet_world.h"

#include <cmath>
#include <stdexcept>
#include <string>

#include "convert.h"
#include "kadans/plant/modelled_drives.h"
#include "plant/bullet/joint/drives.h"
#include "plant_settings_check.h"
#include "sensors.h"

namespace kadans {

using namespace bullet;

namespace {

PlantSettings checked(const RobotModel& model, const PlantSettings& settings) {
  check_settings(model, settings);
  return settings;
}

ContactWorld::Options world_options(const PlantSettings& settings, FrictionLaw friction) {
  return {to_bullet(settings.gravity_m_s2),
          settings.solver_iterations,
          settings.ground_friction,
          to_bullet(ground_pose(settings.world)),
          settings.solver,
          friction};
}

bool finite(const btVector3& v) { return std::isfinite(v.x()) && std::isfinite(v.y()) && std::isfinite(v.z()); }

}  // namespace

class BulletWorld::Inside {
 public:
  Inside(const RobotModel& model, const PlantSettings& settings, std::uint64_t seed, FrictionLaw friction)
      : settings_(checked(model, settings)),
        joint_names_(model.joint_names()),
        mask_(make_pair_mask(model, settings)),
        body_(model, settings),
        drives_(model, settings, body_.multibody()),
        electronics_(settings.drives, model.joints.size()),
        sensors_(model, settings, seed),
        truth_(body_, model.joints.size()),
        objects_(settings.world),
        world_(world_options(settings, friction), mask_) {
    body_.place(settings_);
    body_.add_to(world_);
    objects_.add_to(world_);
    drives_.add_to(world_);
    for (const FootSettings& foot : settings_.feet) {
      feet_.emplace_back();
      feet_.back().link = *model.find_link(foot.link);
    }
    sample(0);
  }

  void write(const ActuationFrame& actuation) noexcept {
    copy_used(actuation, asked_);
    for (std::size_t i = 0; i < drives_.size(); ++i) {
      if (i >= actuation.joint_count || !is_finite(asked_.joints[i])) asked_.joints[i] = {};
    }
    drives_.map(asked_);
    electronics_.write(asked_);
    for (std::size_t i = 0; i < drives_.size(); ++i) drives_.ask(i, asked_.joints[i]);
  }

  void step(std::int64_t dt_ns) {
    if (dt_ns <= 0) return;
    const double dt_s = static_cast<double>(dt_ns) * 1e-9;
    electronics_.step(dt_ns);
    drives_.begin_step(electronics_, dt_s);
    body_.load(settings_.world.payloads, time_s());
    objects_.begin_step(world_, time_s());
    world_.step(dt_s);
    check_finite();
    drives_.end_step(dt_s);
    time_ns_ += dt_ns;
    objects_.end_step(world_, time_s());
    read_feet(world_, body_, settings_.feet, dt_s, feet_);
    sample(dt_s);
  }

  void push(std::size_t link, const Vec3& force_N, const Vec3& point_in_link_m) {
    if (link >= body_.link_count()) throw std::invalid_argument("push: no link number " + std::to_string(link));
    if (!finite(to_bullet(force_N)) || !finite(to_bullet(point_in_link_m))) {
      throw std::invalid_argument("push: force and point must be finite");
    }
    body_.push(link, to_bullet(force_N), to_bullet(point_in_link_m));
  }

  void hash(StateHash& hash) const noexcept {
    const btMultiBody& multibody = body_.multibody();
    const btTransform base = body_.com_frame(0);
    for (int i = 0; i < 3; ++i) hash.add(base.getOrigin()[i]);
    for (int i = 0; i < 4; ++i) hash.add(multibody.getWorldToBaseRot()[i]);
    for (int i = 0; i < 6 + multibody.getNumDofs(); ++i) hash.add(multibody.getVelocityVector()[i]);
    for (std::size_t i = 0; i < drives_.size(); ++i) hash.add(multibody.getJointPos(static_cast<int>(i)));
    drives_.hash(hash);
    electronics_.hash(hash);
    objects_.hash(hash);
    hash_contacts(hash);
    hash_sensors(hash);
  }

  void read(SensorFrame& sensors) const noexcept {
    copy_used(sensors_.frame(), sensors);
    electronics_.fill(sensors);
  }
  const PlantTruth& truth() const noexcept { return truth_.truth(); }

 private:
  double time_s() const { return static_cast<double>(time_ns_) * 1e-9; }

  void sample(double dt_s) {
    truth_.read(drives_, feet_);
    truth_.read_world(world_, objects_, dt_s);
    const Sensors::ImuInput imu{body_.multibody().getBaseOmega(),
                                truth_.base_point_velocity_m_s(to_bullet(settings_.imu.pose.position_m)),
                                body_.link_frame(0).getBasis()};
    sensors_.sample(time_ns_, dt_s, drives_, body_.multibody(), imu, feet_);
  }

  void check_finite() const {
    const btMultiBody& multibody = body_.multibody();
    if (!finite(multibody.getBasePos()) || !finite(multibody.getBaseVel()) || !finite(multibody.getBaseOmega())) {
      throw std::runtime_error("the model's state is not finite: base");
    }
    for (std::size_t i = 0; i < joint_names_.size(); ++i) {
      const int joint = static_cast<int>(i);
      if (std::isfinite(multibody.getJointPos(joint)) && std::isfinite(multibody.getJointVel(joint))) continue;
      throw std::runtime_error("the model's state is not finite: joint '" + joint_names_[i] + "'");
    }
    for (std::size_t i = 0; i < objects_.size(); ++i) {
      if (objects_.finite(i)) continue;
      throw std::runtime_error("the model's state is not finite: '" + settings_.world.objects[i].name + "'");
    }
  }

  void hash_contacts(StateHash& hash) const noexcept {
    for (int i = 0; i < world_.manifold_count(); ++i) {
      const btPersistentManifold& manifold = world_.manifold(i);
      for (int j = 0; j < manifold.getNumContacts(); ++j) {
        const btManifoldPoint& point = manifold.getContactPoint(j);
        for (int k = 0; k < 3; ++k) hash.add(point.m_localPointA[k]);
        hash.add(point.m_distance1);
        hash.add(point.m_appliedImpulse);  // the solver starts from these
        hash.add(point.m_appliedImpulseLateral1);
        hash.add(point.m_appliedImpulseLateral2);
        hash.add(point.m_prevRHS);
      }
    }
  }

  void hash_sensors(StateHash& hash) const noexcept {  // carries the random streams' effect
    const SensorFrame& frame = sensors_.frame();
    for (std::size_t i = 0; i < frame.joint_count; ++i) {
      hash.add(frame.joints[i].position_rad);
      hash.add(frame.joints[i].motor_position_rad);
    }
    hash.add(frame.imu.angular_velocity_rad_s);
    hash.add(frame.imu.acceleration_m_s2);
    for (std::size_t i = 0; i < frame.foot_count; ++i) hash.add(frame.feet[i].force_N);
  }

  PlantSettings settings_;
  std::vector<std::string> joint_names_;
  PairMask mask_;
  Body body_;
  Drives drives_;
  ModelledDrives electronics_;
  ActuationFrame asked_;  // of the drives
  std::vector<FootLoad> feet_;
  Sensors sensors_;
  TruthReader truth_;
  WorldObjects objects_;
  ContactWorld world_;  // last: it lets go of the parts above before they end
  std::int64_t time_ns_ = 0;
};

BulletWorld::BulletWorld(const RobotModel& model, const PlantSettings& settings, std::uint64_t seed)
    : BulletWorld(model, settings, seed, FrictionLaw::cone) {}

BulletWorld::BulletWorld(const RobotModel& model, const PlantSettings& settings, std::uint64_t seed,
                         FrictionLaw friction)
    : inside_(std::make_unique<Inside>(model, settings, seed, friction)) {}

BulletWorld::~BulletWorld() = default;

void BulletWorld::read(SensorFrame& sensors) noexcept { inside_->read(sensors); }

void BulletWorld::write(const ActuationFrame& actuation) noexcept { inside_->write(actuation); }

void BulletWorld::step(std::int64_t dt_ns) { inside_->step(dt_ns); }

const PlantTruth& BulletWorld::truth() const noexcept { return inside_->truth(); }

void BulletWorld::push(std::size_t link, const Vec3& force_N, const Vec3& point_in_link_m) {
  inside_->push(link, force_N, point_in_link_m);
}

void BulletWorld::hash(StateHash& hash) const noexcept { inside_->hash(hash); }

}  // namespace kadans
