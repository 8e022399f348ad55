#include "bullet_robot.h"

#include <cmath>
#include <stdexcept>

#include "convert.h"
#include "plant/bullet/contact/link_contact.h"
#include "plant/bullet/contact/room.h"

namespace kadans::bullet {
BulletRobot::BulletRobot(const WorldSite& site, const PlantSettings& settings, FrictionLaw friction,
                         WorldObjects& objects, bool first)
    : settings_(settings),
      objects_(objects),
      body_(site.model, settings),
      mask_(make_pair_mask(site.model, settings, body_)),
      drives_(site.model, settings, body_.multibody()),
      divergence_(site.model, settings),
      electronics_(settings.drives, site.model.joints.size()),
      sensors_(site.model, settings, site.seed),
      truth_(body_, site.model.joints.size()),
      world_(settings, mask_, friction) {
  check_start(site.model, settings_, body_, mask_);
  body_.place(settings_);
  body_.add_to(world_);
  if (first) objects.add_to(world_);
  drives_.add_to(world_);
  for (const FootSettings& foot : settings_.feet) {
    feet_.emplace_back();
    feet_.back().link = *site.model.find_link(foot.link);
  }
  read_state(0);
}

void BulletRobot::read(SensorFrame& sensors) noexcept {
  copy_used(sensors_.frame(), sensors);
  electronics_.fill(sensors);
}

void BulletRobot::take(const ActuationFrame& actuation) noexcept {
  copy_used(actuation, asked_);
  for (std::size_t i = 0; i < drives_.size(); ++i) {
    if (i >= actuation.joint_count || !is_finite(asked_.joints[i])) asked_.joints[i] = {};
  }
}

void BulletRobot::ask_drives() noexcept {
  electronics_.write(asked_);
  for (std::size_t i = 0; i < drives_.size(); ++i) drives_.ask(i, asked_.joints[i]);
}

void BulletRobot::write(const ActuationFrame& actuation) noexcept {
  take(actuation);
  drives_.map(asked_);
  ask_drives();
}

void BulletRobot::write_drives(const ActuationFrame& drives) noexcept {
  take(drives);
  ask_drives();
}

void BulletRobot::push(std::size_t link, const Vec3& force_N, const Vec3& point_in_link_m) {
  if (link >= body_.link_count()) throw std::invalid_argument("push: no link number " + std::to_string(link));
  if (!finite(to_bullet(force_N)) || !finite(to_bullet(point_in_link_m))) {
    throw std::invalid_argument("push: force and point must be finite");
  }
  body_.push(link, to_bullet(force_N), to_bullet(point_in_link_m));
}

void BulletRobot::carry(double x_m, double y_m, double heading_rad) {
  if (settings_.fixed_base) throw std::invalid_argument("carry: the base is fixed");
  if (!std::isfinite(x_m + y_m + heading_rad)) throw std::invalid_argument("carry: the place must be finite");
  const btVector3 left(-std::sin(heading_rad), std::cos(heading_rad), 0);
  const auto put_down = [&](double to_left_m) {
    body_.carry(settings_.world, x_m + to_left_m * left.x(), y_m + to_left_m * left.y(), heading_rad);
    return !is_crowded(body_.multibody(), worlds_);
  };
  const btTransform was = body_.link_frame(0);
  if (put_down(0)) return;
  for (int i = 1; i * room_step_m <= room_max_m; ++i) {
    if (put_down(i * room_step_m) || put_down(-i * room_step_m)) return;
  }
  body_.carry(settings_.world, was.getOrigin().x(), was.getOrigin().y(), heading_of(was.getBasis()));
  throw std::invalid_argument(no_room("carry"));
}

void BulletRobot::begin_step(std::int64_t dt_ns) {
  electronics_.step(dt_ns);
  drives_.begin_step(electronics_, static_cast<double>(dt_ns) * 1e-9);
  body_.load(settings_.world.payloads, static_cast<double>(time_ns_) * 1e-9);
}

void BulletRobot::end_step(double dt_s) {
  drives_.end_step(dt_s);
  divergence_.look(body_.multibody(), drives_, dt_s, time_ns_);
}

void BulletRobot::sample(std::int64_t dt_ns) {
  const double dt_s = static_cast<double>(dt_ns) * 1e-9;
  time_ns_ += dt_ns;
  read_feet(world_, body_, settings_.feet, dt_s, feet_);
  read_state(dt_s);
}

void BulletRobot::read_state(double dt_s) {
  truth_.read(drives_, feet_);
  truth_.read_world(world_, objects_, dt_s);
  const Sensors::ImuInput imu{body_.multibody().getBaseOmega(),
                              truth_.base_point_velocity_m_s(to_bullet(settings_.imu.pose.position_m)),
                              body_.link_frame(0).getBasis()};
  sensors_.sample(time_ns_, dt_s, drives_, body_.multibody(), imu, feet_);
}

void BulletRobot::hash_body(StateHash& hash) const noexcept {
  const btMultiBody& multibody = body_.multibody();
  const btTransform base = body_.com_frame(0);
  for (int i = 0; i < 3; ++i) hash.add(base.getOrigin()[i]);
  for (int i = 0; i < 4; ++i) hash.add(multibody.getWorldToBaseRot()[i]);
  for (int i = 0; i < 6 + multibody.getNumDofs(); ++i) hash.add(multibody.getVelocityVector()[i]);
  for (std::size_t i = 0; i < drives_.size(); ++i) hash.add(multibody.getJointPos(static_cast<int>(i)));
  drives_.hash(hash);
  electronics_.hash(hash);
}

void BulletRobot::hash_contacts(StateHash& hash) const noexcept {
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

void BulletRobot::hash_sensors(StateHash& hash) const noexcept {
  const SensorFrame& frame = sensors_.frame();
  for (std::size_t i = 0; i < frame.joint_count; ++i) {
    hash.add(frame.joints[i].position_rad);
    hash.add(frame.joints[i].motor_position_rad);
  }
  hash.add(frame.imu.angular_velocity_rad_s);
  hash.add(frame.imu.acceleration_m_s2);
  for (std::size_t i = 0; i < frame.foot_count; ++i) hash.add(frame.feet[i].force_N);
}

}  // namespace kadans::bullet
