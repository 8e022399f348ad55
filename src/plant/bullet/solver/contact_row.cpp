#include "contact_row.h"

#include <algorithm>
#include <cmath>

namespace kadans::bullet {
namespace {

constexpr btScalar smallest_response = 1e-12;  // 1/kg; less cannot move

using Three = std::array<btScalar, 4>;

void add_product(const Three& a, const Three& b, std::array<Three, 3>& sum) {
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = 0; j < 4; ++j) sum[i][j] += a[i] * b[j];
  }
}

}  // namespace

ContactRow::ContactRow(btManifoldPoint& point, const ContactBody& first, const ContactBody& second,
                       const ContactTiming& timing, RowMemory& memory)
    : point_(&point) {
  btPlaneSpace1(point.m_normalWorldOnB, point.m_lateralFrictionDir1, point.m_lateralFrictionDir2);
  directions_ = {point.m_normalWorldOnB, point.m_lateralFrictionDir1, point.m_lateralFrictionDir2};
  add_side(first, point.getPositionWorldOnA(), 1, memory);
  add_side(second, point.getPositionWorldOnB(), -1, memory);
  same_tree_ = side_count_ == 2 && sides_[0].z == sides_[1].z;
  if (same_tree_) add_shared_response();
  aim(timing);
  prepare_gains();
  const Three start{point.m_appliedImpulse, point.m_appliedImpulseLateral1, point.m_appliedImpulseLateral2, 0};
  if (normal_gain_ > 0 && start[0] > 0) apply(start);
}

void ContactRow::add_side(const ContactBody& body, const btVector3& at, btScalar sign, RowMemory& memory) {
  if (body.tree == nullptr) {
    for (std::size_t i = 0; i < 3; ++i) bias_[i] += sign * directions_[i].dot(body.velocity_m_s);
    return;
  }
  Side& side = sides_[static_cast<std::size_t>(side_count_++)];
  side.z = body.tree->z();
  side.path = body.tree->shape().link_path(body.link);
  side.y = reinterpret_cast<Three*>(memory.take(4 * static_cast<std::size_t>(side.path.length)));
  std::array<Wrench, 3> wrenches;
  for (std::size_t i = 0; i < 3; ++i) {
    wrenches[i] = wrench_at(at - body.tree->origin_m(), sign * directions_[i]);
    bias_[i] += body.tree->velocity_along(body.link, wrenches[i]);
  }
  body.tree->response(body.link, wrenches, side.y);
  add_own_response(side);
}

void ContactRow::add_own_response(const Side& side) {
  std::array<Three, 3> sum = response_;
  for (int p = 0; p < side.path.length; ++p) add_product(side.y[p], side.y[p], sum);
  response_ = sum;
}

// Two links of one tree: what pushes one moves the other by the joints that carry both.
void ContactRow::add_shared_response() {
  const Side &a = sides_[0], &b = sides_[1];
  for (int p = 0; p < std::min(a.path.length, b.path.length) && a.path.dofs[p] == b.path.dofs[p]; ++p) {
    add_product(a.y[p], b.y[p], response_);
    add_product(b.y[p], a.y[p], response_);
  }
}

void ContactRow::prepare_gains() {
  const btScalar first = response_[1][1], second = response_[2][2], mixed = response_[1][2];
  if (response_[0][0] > smallest_response) normal_gain_ = 1 / (response_[0][0] + softness_);
  const btScalar determinant = first * second - mixed * mixed;
  if (!(determinant > smallest_response * smallest_response)) return;  // no friction where nothing can slide
  hold_[0] = second / determinant;
  hold_[1] = -mixed / determinant;
  hold_[2] = first / determinant;
  const btScalar half = (first - second) / 2;
  slide_gain_ = 1 / ((first + second) / 2 + std::sqrt(half * half + mixed * mixed));
}

// What the normal velocity must at least be goes into the bias.
void ContactRow::aim(const ContactTiming& timing) {
  const btScalar distance_m = point_->getDistance();
  btScalar wanted = -distance_m / timing.dt_s;
  if ((point_->m_contactPointFlags & BT_CONTACT_FLAG_CONTACT_STIFFNESS_DAMPING) != 0) {
    const btScalar spring_Ns_per_m = timing.dt_s * point_->m_combinedContactStiffness1;
    const btScalar sum_Ns_per_m = spring_Ns_per_m + point_->m_combinedContactDamping1;
    softness_ = 1 / (timing.dt_s * sum_Ns_per_m);
    wanted *= spring_Ns_per_m / sum_Ns_per_m;
  } else if (distance_m <= 0) {
    const bool own = (point_->m_contactPointFlags & BT_CONTACT_FLAG_HAS_CONTACT_ERP) != 0;
    wanted *= own ? point_->m_contactERP : timing.erp;
  }
  // How fast the two came, not what the impulses of this step have made of it so far: a ball between ground and weight
  // would bounce off the ground for being pressed onto it.
  if (point_->m_combinedRestitution > 0) {
    const btScalar approach = -bias_[0];
    if (approach > timing.restitution_velocity_m_s) wanted += point_->m_combinedRestitution * approach;
  }
  bias_[0] -= wanted;
}

ContactRow::Three ContactRow::velocity() const {
  Three sum = bias_;
  for (int s = 0; s < side_count_; ++s) {
    const Side& side = sides_[static_cast<std::size_t>(s)];
#pragma GCC unroll 4
    for (int p = 0; p < side.path.length; ++p) {
      const btScalar z = side.z[side.path.dofs[p]];
      for (std::size_t i = 0; i < 4; ++i) sum[i] += side.y[p][i] * z;
    }
  }
  return sum;
}

inline void ContactRow::apply(const Three& change) {
  for (std::size_t i = 0; i < 3; ++i) impulse_[i] += change[i];
  for (int s = 0; s < side_count_; ++s) {
    const Side& side = sides_[static_cast<std::size_t>(s)];
#pragma GCC unroll 4
    for (int p = 0; p < side.path.length; ++p) {
      const Three& y = side.y[p];
      side.z[side.path.dofs[p]] += y[0] * change[0] + y[1] * change[1] + y[2] * change[2];
    }
  }
}

btScalar ContactRow::iterate(FrictionLaw law, btScalar share) {
  Three v = velocity();
  Three wanted{std::max(btScalar(0), impulse_[0] - normal_gain_ * (v[0] + softness_ * impulse_[0])), 0, 0, 0};
  if (wanted[0] == 0 && impulse_[0] == 0) return 0;
  const btScalar normal_change = wanted[0] - impulse_[0];
  v[1] += response_[0][1] * normal_change;
  v[2] += response_[0][2] * normal_change;
  hold_or_slide(v, point_->m_combinedFriction * wanted[0], law, wanted);
  const Three change{normal_change, wanted[1] - impulse_[1], wanted[2] - impulse_[2], 0};
  apply({share * change[0], share * change[1], share * change[2], 0});
  return std::abs(change[0]) * response_[0][0] + std::abs(change[1]) * response_[1][1] +
         std::abs(change[2]) * response_[2][2];
}

void ContactRow::hold_or_slide(const Three& v, btScalar limit, FrictionLaw law, Three& impulse) const {
  if (law == FrictionLaw::pyramid) {
    impulse[1] = std::clamp(impulse_[1] - v[1] / response_[1][1], -limit, limit);
    const btScalar after = v[2] + response_[1][2] * (impulse[1] - impulse_[1]);
    impulse[2] = std::clamp(impulse_[2] - after / response_[2][2], -limit, limit);
    return;
  }
  impulse[1] = impulse_[1] - (hold_[0] * v[1] + hold_[1] * v[2]);
  impulse[2] = impulse_[2] - (hold_[1] * v[1] + hold_[2] * v[2]);
  if (impulse[1] * impulse[1] + impulse[2] * impulse[2] <= limit * limit) return;
  impulse[1] = impulse_[1] - slide_gain_ * v[1];
  impulse[2] = impulse_[2] - slide_gain_ * v[2];
  const btScalar length2 = impulse[1] * impulse[1] + impulse[2] * impulse[2];
  if (length2 <= limit * limit) return;
  const btScalar scale = limit / std::sqrt(length2);
  impulse[1] *= scale;
  impulse[2] *= scale;
}

void ContactRow::finish() const {
  point_->m_appliedImpulse = impulse_[0];
  point_->m_appliedImpulseLateral1 = impulse_[1];
  point_->m_appliedImpulseLateral2 = impulse_[2];
  point_->m_prevRHS = 0;  // the stock solver's own start, unused
}

}  // namespace kadans::bullet
