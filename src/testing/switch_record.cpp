#include "kadans/testing/switch_record.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <ostream>

#include "kadans/testing/joint_bench.h"
#include "telemetry/plot.h"

namespace kadans::testing {
namespace {

constexpr double converged_share = 0.02;

double converged_s(const SwitchRecord& record, double limit_Nm) {
  const std::vector<double>& torque = record.torque_Nm;
  const std::size_t tail = std::max<std::size_t>(1, torque.size() / 10);
  double end_Nm = 0;
  for (std::size_t i = torque.size() - tail; i < torque.size(); ++i) end_Nm += torque[i] / static_cast<double>(tail);
  std::size_t settled = torque.size();
  while (settled > 0 && std::abs(torque[settled - 1] - end_Nm) <= converged_share * limit_Nm) --settled;
  if (settled == torque.size()) return std::numeric_limits<double>::quiet_NaN();
  return settled == 0 ? 0 : record.dt_s * static_cast<double>(settled);
}

}  // namespace

SwitchRecord record_switch(JointBench& bench, std::string_view object, double duration_s) {
  SwitchRecord record{.dt_s = bench.config().dt_s};
  const double limit_Nm = bench.effort_max_Nm();
  const auto delay = bench.config().plant.delay_ticks;
  const auto ticks = std::llround(duration_s / record.dt_s);
  bench.switch_to(object);
  for (std::uint32_t i = 0; i <= delay; ++i) bench.tick();  // the old object's torque, until the new one's arrives
  double before_Nm = bench.plant().state().last_torque_Nm;
  record.torque_Nm.push_back(before_Nm);
  for (long long i = 0; i < ticks; ++i) {
    bench.tick();
    const double step_share = std::abs(bench.plant().state().first_torque_Nm - before_Nm) / limit_Nm;
    if (i == 0) record.first_step_share = step_share;
    if (!(step_share <= record.largest_step_share)) record.largest_step_share = step_share;
    before_Nm = bench.plant().state().last_torque_Nm;
    record.torque_Nm.push_back(before_Nm);
  }
  record.converged_s = converged_s(record, limit_Nm);
  return record;
}

bool operator<=(const SwitchRecord& record, const SwitchLimits& limits) noexcept {
  return record.first_step_share <= limits.first_step_share && record.converged_s <= limits.converged_s;
}

std::ostream& operator<<(std::ostream& out, const SwitchRecord& record) {
  out << "switch: first step " << 100 * record.first_step_share << " % of the limit, largest "
      << 100 * record.largest_step_share << " %, converged after " << record.converged_s << " s\n";
  const double duration_s = record.dt_s * static_cast<double>(record.torque_Nm.size() - 1);
  return out << curve_text("", record.torque_Nm, 0, duration_s, {.rows = 6});
}

std::ostream& operator<<(std::ostream& out, const SwitchLimits& limits) {
  return out << "first step <= " << 100 * limits.first_step_share << " %, converged <= " << limits.converged_s << " s";
}

}  // namespace kadans::testing
