#include <algorithm>

#include "signal_plot.h"

namespace kadans {
namespace {

// Whether one path is the other, or lies inside it: "walk" and "walk.left".
bool within(const std::string& inner, const std::string& outer) {
  return inner == outer || (inner.size() > outer.size() && inner.starts_with(outer) && inner[outer.size()] == '.');
}

struct Lane {
  std::string behavior, state;  // state: "" when nothing is active
  double since_s = 0;
  std::vector<PlotBand> bands;
};

class Lanes {
 public:
  Lanes(double from_s, double to_s) noexcept : from_s_(from_s), to_s_(to_s) {}

  void add(const Transition& transition) {
    const double time_s = seconds(transition.time_ns);
    Lane& lane = lane_for(transition, time_s);
    end(lane, time_s);
    lane.state = transition.to;
    lane.since_s = time_s;
  }

  std::vector<PlotLane> take() {
    std::vector<PlotLane> all;
    for (Lane& lane : lanes_) {
      end(lane, to_s_);
      if (!lane.bands.empty()) all.push_back({lane.behavior, std::move(lane.bands)});
    }
    return all;
  }

 private:
  // Where the state that is left stands; when several lie inside it, they end and the first goes on.
  Lane& lane_for(const Transition& transition, double time_s) {
    std::vector<Lane*> left;
    for (Lane& lane : lanes_) {
      if (lane.behavior != transition.behavior) continue;
      if (!transition.from.empty() && lane.state == transition.from) return lane;
      const bool related = transition.from.empty()
                               ? lane.state.empty()
                               : within(lane.state, transition.from) || within(transition.from, lane.state);
      if (related) left.push_back(&lane);
    }
    for (std::size_t i = 1; i < left.size() && !transition.from.empty(); ++i) {
      end(*left[i], time_s);
      left[i]->state.clear();
    }
    if (!left.empty()) return *left.front();
    lanes_.push_back({transition.behavior, transition.from, from_s_, {}});
    return lanes_.back();
  }

  void end(Lane& lane, double time_s) const {
    const double from_s = std::max(lane.since_s, from_s_), to_s = std::min(time_s, to_s_);
    if (!lane.state.empty() && to_s > from_s) lane.bands.push_back({from_s, to_s, lane.state});
  }

  double from_s_, to_s_;
  std::vector<Lane> lanes_;
};

}  // namespace

std::vector<PlotLane> state_lanes(const std::vector<Transition>& transitions, double from_s, double to_s) {
  Lanes lanes(from_s, to_s);
  for (const Transition& transition : transitions) lanes.add(transition);
  return lanes.take();
}

}  // namespace kadans
