
#include "signal_plot.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <optional>

namespace kadans {

PlotColumns::PlotColumns(double from_s, double to_s, std::size_t columns) noexcept
    : from_s_(from_s), per_s_(to_s > from_s ? static_cast<double>(columns) / (to_s - from_s) : 0), columns_(columns) {}

void PlotColumns::add(double time_s, double value) {
  const double place = std::floor((time_s - from_s_) * per_s_);
  const auto at = static_cast<std::size_t>(std::clamp(place, 0.0, static_cast<double>(columns_ - 1)));
  if (!std::isfinite(value)) {
    end_column();
    if (!points_.empty() && std::isfinite(points_.back().y))
      points_.push_back({time_s, std::numeric_limits<double>::quiet_NaN()});
    return;
  }
  const PlotPoint point{time_s, value};
  if (open_ && at != at_) end_column();
  if (!open_) {
    column_ = {point, point, point, point};
    open_ = true;
    at_ = at;
  }
  if (value < column_.lowest.y) column_.lowest = point;
  if (value > column_.highest.y) column_.highest = point;
  column_.last = point;
}

void PlotColumns::end_column() {
  if (!open_) return;
  open_ = false;
  PlotPoint inner[] = {column_.lowest, column_.highest};
  if (inner[0].x > inner[1].x) std::swap(inner[0], inner[1]);
  points_.push_back(column_.first);
  for (const PlotPoint& point : {inner[0], inner[1], column_.last}) {
    if (point.x > points_.back().x) points_.push_back(point);
  }
}

std::vector<PlotPoint> PlotColumns::points() {
  end_column();
  return std::move(points_);
}

std::vector<PanelWish> panels_by_unit(const std::vector<ChosenSignal>& signals) {
  std::vector<PanelWish> panels;
  for (const ChosenSignal& signal : signals) {
    const auto same = [&](const PanelWish& panel) { return panel.signals.front().info.unit == signal.info.unit; };
    const auto known = std::ranges::find_if(panels, same);
    if (known != panels.end())
      known->signals.push_back(signal);
    else
      panels.push_back({.title = "", .signals = {signal}});
  }
  return panels;
}

namespace {

TimeSpan clipped(const RecordOutline& record, TimeSpan span) {
  return {std::max(span.from_ns, record.first_ns), std::min(span.to_ns, record.last_ns)};
}

std::string unit_of(const PanelWish& wish) {
  const std::string& unit = wish.signals.front().info.unit;
  const bool one = std::ranges::all_of(wish.signals, [&](const ChosenSignal& s) { return s.info.unit == unit; });
  return one ? unit : "";
}

struct Target {
  std::size_t place = 0;
  PlotColumns* columns = nullptr;
  std::optional<double> before;  // what it held when the span began
};

void read_columns(const std::string& file, TimeSpan span, std::map<std::uint16_t, std::vector<Target>>& targets) {
  RecordRows rows(file);
  while (rows.next()) {
    if (rows.values().empty() || rows.time_ns() > span.to_ns) continue;
    const auto wanted = targets.find(rows.channel());
    if (wanted == targets.end()) continue;
    for (Target& target : wanted->second) {
      const double value = rows.values()[target.place];
      if (rows.time_ns() < span.from_ns) {
        target.before = value;
        continue;
      }
      if (target.before && rows.time_ns() > span.from_ns) target.columns->add(seconds(span.from_ns), *target.before);
      target.before.reset();
      target.columns->add(seconds(rows.time_ns()), value);
    }
  }
}

}  // namespace

SignalPlot plot_of(const RecordOutline& record, const std::vector<PanelWish>& wishes, TimeSpan span,
                   std::size_t columns) {
  const TimeSpan shown = clipped(record, span);
  SignalPlot plot{.title = "",
                  .from_s = seconds(shown.from_ns),
                  .to_s = seconds(shown.to_ns),
                  .panels = {},
                  .lanes = {},
                  .marks = {}};
  std::vector<std::vector<PlotColumns>> thinned;
  std::map<std::uint16_t, std::vector<Target>> targets;
  for (const PanelWish& wish : wishes)
    thinned.emplace_back(wish.signals.size(), PlotColumns(plot.from_s, plot.to_s, columns));
  for (std::size_t i = 0; i < wishes.size(); ++i) {
    for (std::size_t j = 0; j < wishes[i].signals.size(); ++j) {
      const ChosenSignal& signal = wishes[i].signals[j];
      targets[signal.channel].push_back({signal.place, &thinned[i][j], std::nullopt});
    }
  }
  read_columns(record.file, shown, targets);
  for (std::size_t i = 0; i < wishes.size(); ++i) {
    PlotPanel panel{.title = wishes[i].title, .unit = unit_of(wishes[i]), .lines = {}};
    for (std::size_t j = 0; j < wishes[i].signals.size(); ++j)
      panel.lines.push_back({wishes[i].signals[j].info.name, thinned[i][j].points()});
    plot.panels.push_back(std::move(panel));
  }
  plot.lanes = state_lanes(record.transitions, plot.from_s, plot.to_s);
  for (const ToldFault& fault : record.faults) {
    if (shown.holds(fault.time_ns)) plot.marks.push_back({seconds(fault.time_ns), fault_name(fault)});
  }
  return plot;
}

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
    std::vector<Lane*> leaving;
    for (Lane& lane : lanes_) {
      if (lane.behavior != transition.behavior) continue;
      if (!transition.from.empty() && lane.state == transition.from) return lane;
      const bool related = transition.from.empty()
                               ? lane.state.empty()
                               : within(lane.state, transition.from) || within(transition.from, lane.state);
      if (related) leaving.push_back(&lane);
    }
    for (std::size_t i = 1; i < leaving.size() && !transition.from.empty(); ++i) {
      end(*leaving[i], time_s);
      leaving[i]->state.clear();
    }
    if (!leaving.empty()) return *leaving.front();
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
