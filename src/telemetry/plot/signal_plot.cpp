
#include "signal_plot.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <optional>
#include <system_error>

#include "realtime/machine/child_process.h"
#include "signal/input_file.h"
#include "signal/number_text.h"
#include "signal/utf8.h"
#include "telemetry/plot.h"

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
  plot.lanes = record.active.empty() ? state_lanes(record.transitions, plot.from_s, plot.to_s)
                                     : state_lanes(record.active, plot.from_s, plot.to_s);
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

// How much two paths have in common, in letters.
std::size_t common(const std::string& a, const std::string& b) {
  return static_cast<std::size_t>(std::ranges::mismatch(a, b).in1 - a.begin());
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

  // What goes on keeps its lane. A lane whose state is over takes the new state that is nearest to it; what is left
  // takes the first lane in which nothing is active.
  void show(const Event& active) {
    const double time_s = seconds(active.transition.time_ns);
    std::vector<std::string> fresh = active.states;
    const auto is_its = [&](const Lane& lane) { return lane.behavior == active.transition.behavior; };
    const auto goes_on = [&](const Lane& lane) {
      return std::ranges::find(active.states, lane.state) != active.states.end();
    };
    std::erase_if(fresh, [&](const std::string& state) {
      return std::ranges::any_of(lanes_, [&](const Lane& lane) { return is_its(lane) && lane.state == state; });
    });
    for (Lane& lane : lanes_) {
      if (!is_its(lane) || lane.state.empty() || goes_on(lane)) continue;
      end(lane, time_s);
      const auto nearest =
          std::ranges::max_element(fresh, {}, [&](const std::string& s) { return common(s, lane.state); });
      begin(lane, fresh, nearest, time_s);
    }
    for (Lane& lane : lanes_) {
      if (is_its(lane) && lane.state.empty()) begin(lane, fresh, fresh.begin(), time_s);
    }
    while (!fresh.empty()) {
      lanes_.push_back({active.transition.behavior, "", 0, {}});
      begin(lanes_.back(), fresh, fresh.begin(), time_s);
    }
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

  static void begin(Lane& lane, std::vector<std::string>& fresh, std::vector<std::string>::iterator state,
                    double time_s) {
    lane.state.clear();
    if (state == fresh.end()) return;
    lane.state = std::move(*state);
    lane.since_s = time_s;
    fresh.erase(state);
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

std::vector<PlotLane> state_lanes(const std::vector<Event>& active, double from_s, double to_s) {
  Lanes lanes(from_s, to_s);
  for (const Event& told : active) lanes.show(told);
  return lanes.take();
}

namespace {

constexpr int left = 92, gap = 16, title_height = 34, lane_height = 20, mark_height = 16, axis_height = 46;
constexpr int line_height = 16, title_gap = 22, points_a_letter = 7;

// In single quotes nothing means anything to gnuplot but the quote, doubled.
std::string quoted(const std::string& text) {
  std::string safe = "'";
  for (const char c : xml_characters(text)) {
    if (c == '\'') safe += '\'';
    safe += static_cast<unsigned char>(c) < 0x20U ? ' ' : c;
  }
  return safe + '\'';
}

class Script {
 public:
  Script(const SignalPlot& plot, PlotFormat format, PlotSize size) : plot_(plot), size_(size) {
    height_ = (plot.title.empty() ? gap : title_height) + lanes_height() + axis_height;
    for (const PlotPanel& panel : plot.panels) height_ += panel_height(panel) + gap + head_of(panel);
    std::size_t longest = 0;
    for (const PlotPanel& panel : plot.panels) {
      for (const PlotLine& line : panel.lines) longest = std::max(longest, line.label.size());
    }
    legend_ = std::clamp(static_cast<int>(longest) * points_a_letter + 48, 150, size.width / 2 - left);
    const char* const terminal = format == PlotFormat::svg ? "svg" : "pngcairo";
    add(printed("set terminal %s size %d,%d font '%s' background '%s' noenhanced\n", terminal, size.width, height_,
                format == PlotFormat::svg ? "sans-serif,12" : "DejaVu Sans,9", plot_ink::paper.light));
    add("set encoding utf8\nset multiplot\n");
    add(printed("set xrange [%.9g:%.9g]\n", plot.from_s, plot.to_s > plot.from_s ? plot.to_s : plot.from_s + 1));
  }

  std::string write() {
    int top = gap;
    if (!plot_.title.empty()) {
      add("set label 1 " + quoted(plot_.title) + printed(" at screen %.5f,%.5f left ", x(left), y(18)) + ink() + "\n");
      top = title_height;
    }
    strip(top);
    add("unset label 1\n");
    top += lanes_height();
    for (std::size_t i = 0; i < plot_.panels.size(); ++i) {
      top += head_of(plot_.panels[i]);
      panel(plot_.panels[i], top, i + 1 == plot_.panels.size());
      top += panel_height(plot_.panels[i]) + gap;
    }
    add("unset multiplot\n");
    return std::move(text_);
  }

 private:
  void add(const std::string& text) { text_ += text; }
  static std::string ink() { return printed("textcolor rgb '%s'", plot_ink::text.light); }
  double x(int pixels) const { return static_cast<double>(pixels) / size_.width; }
  double y(int pixels) const { return 1 - static_cast<double>(pixels) / height_; }
  static const char* color_of(const PlotMark& mark) { return (mark.fault ? plot_ink::fault : plot_ink::push).light; }
  static int head_of(const PlotPanel& panel) { return panel.title.empty() ? 0 : title_gap; }
  int panel_height(const PlotPanel& panel) const {
    return std::max(size_.panel_height, line_height * static_cast<int>(panel.lines.size()) + 8);
  }
  int lanes_height() const {
    if (plot_.lanes.empty() && plot_.marks.empty()) return 0;
    return lane_height * static_cast<int>(plot_.lanes.size()) + (plot_.marks.empty() ? 0 : mark_height) + gap / 2;
  }
  double pixels_a_second() const { return (size_.width - left - legend_) / std::max(plot_.to_s - plot_.from_s, 1e-9); }

  void place(int top, int height) {
    add(printed("set lmargin at screen %.5f\nset rmargin at screen %.5f\nset tmargin at screen %.5f\n", x(left),
                x(size_.width - legend_), y(top)) +
        printed("set bmargin at screen %.5f\n", y(top + height)));
  }

  // Names of the states in boxes, and of the faults above them.
  void strip(int top) {
    const int marks = plot_.marks.empty() ? 0 : mark_height;
    const int height = lanes_height() - marks - gap / 2;
    if (lanes_height() == 0) return;
    place(top + marks, std::max(height, 1));
    add("unset border\nunset tics\nunset key\n");
    const std::size_t count = std::max<std::size_t>(plot_.lanes.size(), 1);
    add(printed("set yrange [%zu:0]\n", count));
    for (std::size_t i = 0; i < plot_.lanes.size(); ++i) lane(plot_.lanes[i], i);
    mark_names();
    add(printed("plot -1 notitle lc rgb '%s'\nunset object\nunset label\n", plot_ink::paper.light));
  }

  void lane(const PlotLane& lane, std::size_t row) {
    const double at = static_cast<double>(row);
    add("set label " + quoted(lane.name) + printed(" at graph -0.012, first %.2f right ", at + 0.5) + ink() + "\n");
    std::vector<std::string> colored;  // a state has the same color wherever it comes
    for (const PlotBand& band : lane.bands) {
      auto known = std::ranges::find(colored, band.label);
      if (known == colored.end()) known = colored.insert(colored.end(), band.label);
      const char* const color =
          plot_ink::states.at(static_cast<std::size_t>(known - colored.begin()) % plot_ink::states.size()).light;
      const double width = (band.to_s - band.from_s) * pixels_a_second();
      if (width < 0.3) continue;  // thousands of them would hide each other anyway
      add(printed("set object rect from first %.9g, first %.2f to first %.9g, first %.2f fc rgb '%s' ", band.from_s,
                  at + 0.06, band.to_s, at + 0.94, color) +
          printed("fs solid border lc rgb '%s' lw 0.5\n", plot_ink::paper.light));
      const std::string name = fitting(band.label, width);
      if (!name.empty())
        add("set label " + quoted(name) +
            printed(" at first %.9g, first %.2f center front ", 0.5 * (band.from_s + band.to_s), at + 0.5) + ink() +
            "\n");
    }
  }

  // The whole path, its last part, or nothing.
  static std::string fitting(const std::string& path, double width) {
    const auto fits = [width](const std::string& name) {
      return static_cast<double>(name.size()) * points_a_letter + 4 <= width;
    };
    if (fits(path)) return path;
    const std::string last = path.substr(path.rfind('.') + 1);
    return fits(last) ? last : "";
  }

  // One name where there is room for one, and how many more stand there.
  void mark_names() {
    for (std::size_t i = 0; i < plot_.marks.size();) {
      const PlotMark& mark = plot_.marks[i];
      const double room_s = static_cast<double>(mark.label.size() + 4) * points_a_letter / pixels_a_second();
      const std::size_t first = i;
      while (i < plot_.marks.size() && plot_.marks[i].time_s <= mark.time_s + room_s) ++i;
      const std::string more = i - first > 1 ? " +" + std::to_string(i - first - 1) : "";
      add("set label " + quoted(mark.label + more) +
          printed(" at first %.9g, graph 1 left offset 0,0.6 textcolor rgb '%s'\n", mark.time_s, color_of(mark)));
    }
  }

  void panel(const PlotPanel& panel, int top, bool last) {
    place(top, panel_height(panel));
    const PlotRange range = widened(range_of(panel.lines), 0.06, 1e-8);
    add(printed("set yrange [%.9g:%.9g]\n", range.low, range.high));
    shades();
    mark_lines();
    add(printed("set border 3 lc rgb '%s' lw 0.8\n", plot_ink::frame.light));
    add(std::string("set xtics out nomirror ") + (last ? "format '%g' " : "format '' ") + ink() + "\n");
    add("set ytics out nomirror format '%g' " + ink() + "\n");
    add(printed("set grid xtics ytics lt 1 lc rgb '%s' lw 0.6\n", plot_ink::grid.light));
    add(last ? "set xlabel 'time, s' " + ink() + "\n" : "unset xlabel\n");
    if (!panel.unit.empty())
      add("set label " + quoted(panel.unit) + printed(" at screen %.5f, graph 0.5 center rotate by 90 ", x(16)) +
          ink() + "\n");
    if (!panel.title.empty())
      add("set label " + quoted(panel.title) + " at graph 0, graph 1 left offset 0,0.7 " + ink() + "\n");
    add(printed("set key at screen %.5f, screen %.5f left top reverse Left samplen 1.4 spacing 1.0 ",
                x(size_.width - legend_ + 8), y(top - 2)) +
        ink() + "\n");
    lines(panel);
    add("unset object\nunset arrow\nunset label\n");
  }

  // Every other state of the behavior that stands first, of those that can be seen.
  void shades() {
    if (plot_.lanes.empty()) return;
    bool shaded = true;
    for (const PlotBand& band : plot_.lanes.front().bands) {
      if ((band.to_s - band.from_s) * pixels_a_second() < 2) continue;
      shaded = !shaded;
      if (!shaded) continue;
      add(printed("set object rect from first %.9g, graph 0 to first %.9g, graph 1 behind fc rgb '%s' ", band.from_s,
                  band.to_s, plot_ink::shade.light) +
          "fs solid noborder\n");
    }
  }

  void mark_lines() {
    double before = -INFINITY;
    for (const PlotMark& mark : plot_.marks) {
      const double at = mark.time_s * pixels_a_second();
      if (at - before < 1) continue;
      before = at;
      add(printed("set arrow from first %.9g, graph 0 to first %.9g, graph 1 nohead lc rgb '%s' lw 1 dt 2\n",
                  mark.time_s, mark.time_s, color_of(mark)));
    }
  }

  void lines(const PlotPanel& panel) {
    std::string command = "plot ";
    for (std::size_t i = 0; i < panel.lines.size(); ++i) {
      add(printed("$d%zu << EOD\n", i));
      for (const PlotPoint& point : panel.lines[i].points)
        add(std::isfinite(point.y) ? printed("%.9g %.7g\n", point.x, point.y) : "\n");
      add(panel.lines[i].points.empty() ? printed("%.9g NaN\nEOD\n", plot_.from_s) : "EOD\n");
      const std::size_t dashes = i / plot_ink::lines.size() % 4;
      command += printed("%s$d%zu using 1:2 with lines lw 1.4 lc rgb '%s' dt %zu title ", i == 0 ? "" : ", ", i,
                         plot_ink::lines.at(i % plot_ink::lines.size()).light, dashes + 1) +
                 quoted(panel.lines[i].label);
    }
    add(command + "\n");
  }

  const SignalPlot& plot_;
  PlotSize size_;
  int height_ = 0, legend_ = 0;
  std::string text_;
};

}  // namespace

std::string gnuplot_script(const SignalPlot& plot, PlotFormat format, PlotSize size) {
  return Script(plot, format, size).write();
}

// Gnuplot writes a color in two ways, "rgb( 28,  40,  51)" and "rgb(28,40,51)", and the paper's as it was given.
std::string dark_plot_style() {
  std::string style = "@media (prefers-color-scheme: dark) {\n";
  const auto add = [&style](const PlotColor& color) {
    unsigned red = 0, green = 0, blue = 0;
    (void)std::sscanf(color.light, "#%2x%2x%2x", &red, &green, &blue);  // NOLINT: our own constants
    const std::string ways[] = {printed("rgb(%3u, %3u, %3u)", red, green, blue),
                                printed("rgb(%u,%u,%u)", red, green, blue), color.light};
    for (const char* const what : {"fill", "stroke", "color"}) {
      style += "svg ";
      for (std::size_t i = 0; i < 3; ++i)
        style += std::string(i == 0 ? "[" : ", svg [") + what + "=\"" + ways[i] + "\"]";
      style += " { " + std::string(what) + ": " + color.dark + "; }\n";
    }
  };
  for (const PlotColor& color : {plot_ink::paper, plot_ink::text, plot_ink::frame, plot_ink::grid, plot_ink::shade,
                                 plot_ink::fault, plot_ink::push})
    add(color);
  for (const PlotColor& color : plot_ink::states) add(color);
  for (const PlotColor& color : plot_ink::lines) add(color);
  return style + "}\n";
}

std::string draw(const SignalPlot& plot, PlotFormat format, PlotSize size) {
  ProgramOutput drawn;
  try {
    drawn = run_program({"gnuplot", "-d"}, gnuplot_script(plot, format, size));  // -d: nobody's settings but ours
  } catch (const std::system_error& error) {
    if (error.code() != std::errc::no_such_file_or_directory) throw;
    refuse("plots are drawn by gnuplot, which is not here: install the package gnuplot-nox");
  }
  if (drawn.exit_code != 0 || drawn.out.empty()) refuse("gnuplot failed: " + drawn.err.substr(0, 500));
  return drawn.out;
}

}  // namespace kadans
