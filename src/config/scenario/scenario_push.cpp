#include "scenario_push.h"

#include <numbers>

namespace kadans {
namespace {

const std::array<std::string, 2> shape_names{"constant", "half_sine"};

}  // namespace

void push_fields(Fields& f, ScenarioPush& push, Problems& problems) {
  constexpr NumberRange time{0, 1e6, "s"};
  f.string("link", push.link.name, "the link that is pushed", Need::required);
  f.number("at_s", push.at_s, time, "when", Need::required);
  f.number("duration_s", push.duration_s, {1e-3, 1e6, "s"}, "how long");
  f.choice("shape", push.shape, shape_names, "how the force goes over its time");
  f.numbers("impulse_Ns", push.impulse_Ns, {-push_max_Ns, push_max_Ns, "Ns"},
            "the whole push, world axes: x forward, y left, z up");
  Vec3 force_N{};
  f.numbers("force_N", force_N, {-1e5, 1e5, "N"}, "or the force, of half_sine its peak");
  f.numbers("point_m", push.point_m, {-10, 10, "m"}, "where on the link, in its frame");
  if (!f.reading()) return;
  push.link.place = f.place("link");
  if (f.has("impulse_Ns") == f.has("force_N")) {
    problems.add(f.place(), f.path() + " must have one of impulse_Ns and force_N");
    return;
  }
  if (f.has("impulse_Ns")) return;
  const double mean = push.shape == ScenarioPush::Shape::half_sine ? 2 / std::numbers::pi : 1;
  for (std::size_t i = 0; i < 3; ++i) push.impulse_Ns[i] = force_N[i] * mean * push.duration_s;
}

}  // namespace kadans
