#include "run_page.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "app/live/record_pictures.h"
#include "kadans/signal/nearest_name.h"
#include "kadans/signal/output_file.h"
#include "version.h"

namespace kadans {
namespace {

namespace fs = std::filesystem;

constexpr int pictures = 8;

// Adds the plots, and the robot's name from the record.
void add_plot(const RunPage& page, HtmlReport& report) {
  if (page.record.empty()) {
    report.no_plot = report.no_film = "the run left no record";
    return;
  }
  try {
    const RecordOutline record = outline_of(page.record);
    if (const std::string robot = record.robot(); !robot.empty()) report.robot = robot;
    const SignalPlot plot = run_plot(record, page);
    if (plot.panels.empty()) {
      report.no_plot = "the record holds none of the signals that are usually shown";
      return;
    }
    report.plot = draw(plot, PlotFormat::svg, {.width = 1200, .panel_height = 150});
    report.plot_style = dark_plot_style();
  } catch (const InputError& error) {
    report.no_plot = error.what();
  }
}

void add_film(const RunPage& page, const ReportOptions& place, HtmlReport& report) {
  if (place.film == "never") report.no_film = "not asked for (--film never)";
  if (place.film == "failed" && page.run.result.passed)
    report.no_film = "the run passed; --film always draws them all the same";
  const double duration_s = page.run.result.duration_s;
  if (report.no_film.empty()) report.no_film = pictures_missing();
  if (report.no_film.empty() && !(duration_s > 0)) report.no_film = "the run has no duration";
  if (!report.no_film.empty()) return;
  try {
    const PictureOptions picture{
        .record = page.record, .every_s = duration_s / (pictures - 0.5), .width = 480, .height = 360};
    draw_record(picture, [&report](const std::string& name, std::string bytes) {
      report.film.push_back({std::stod(name), std::move(bytes)});
    });
  } catch (const InputError& error) {
    report.no_film = error.what();
  }
}

constexpr std::size_t joints_shown = 4, curves_max = 12;

struct Usual {
  const char* title;
  std::vector<const char*> patterns;
};
const std::vector<Usual>& usual_panels() {
  static const std::vector<Usual> all{
      {"height of the base", {"plant.base.height_m", "reference.base.height_m"}},
      {"lean of the base", {"plant.base.tilt_rad", "base.tilt_rad"}},
      {"force on the feet", {"plant.foot.*.force_N"}},
      {"how much of the limits is used", {"plant.limits.torque_share", "plant.limits.speed_share"}},
      {"how far off the gaze is", {"plant.*.error_rad"}},
      {"rung of the safety layer", {"safety.robot_level"}},
      {"what ticks cost", {"timing.*_ns", "timing.*_us"}},
  };
  return all;
}

// The same as choose_signals, but missing signals are left out.
std::vector<ChosenSignal> present(const std::vector<ChosenSignal>& all, const std::vector<std::string>& patterns) {
  std::vector<ChosenSignal> chosen;
  for (const std::string& pattern : patterns) {
    for (const ChosenSignal& signal : all) {
      const auto same = [&](const ChosenSignal& one) { return one.info.name == signal.info.name; };
      if (chosen.size() < curves_max && matches(pattern, signal.info.name) && std::ranges::none_of(chosen, same))
        chosen.push_back(signal);
    }
  }
  return chosen;
}

struct Mover {
  ChosenSignal signal;
  double low = std::numeric_limits<double>::infinity(), high = -std::numeric_limits<double>::infinity();
  double range() const noexcept { return high >= low ? high - low : 0; }
};

// The positions of joints; those that moved most come first.
std::vector<Mover> movers(const RecordOutline& record, const std::vector<ChosenSignal>& all) {
  std::vector<Mover> joints;
  for (const ChosenSignal& signal : all) {
    if (matches("joint.*.position_rad", signal.info.name)) joints.push_back({signal});
  }
  RecordRows rows(record.file);
  while (rows.next()) {
    if (rows.values().empty()) continue;
    for (Mover& joint : joints) {
      if (joint.signal.channel != rows.channel()) continue;
      joint.low = std::min(joint.low, rows.values()[joint.signal.place]);
      joint.high = std::max(joint.high, rows.values()[joint.signal.place]);
    }
  }
  std::ranges::stable_sort(joints, std::ranges::greater{}, &Mover::range);
  joints.resize(std::min(joints.size(), joints_shown));
  return joints;
}

// "joint.l_knee.position_rad" -> "l_knee"
std::string joint_in(const std::string& name) {
  const std::size_t begin = name.find('.') + 1;
  return name.substr(begin, name.rfind('.') - begin);
}

std::vector<PanelWish> wishes_of(const RecordOutline& record, const std::vector<std::string>& check_signals) {
  const std::vector<ChosenSignal> all = choose_signals(record, {});
  std::vector<PanelWish> wishes;
  const auto wish = [&](const std::string& title, const std::vector<std::string>& patterns) {
    if (std::vector<ChosenSignal> chosen = present(all, patterns); !chosen.empty())
      wishes.push_back({title, std::move(chosen)});
  };
  for (const Usual& usual : usual_panels()) wish(usual.title, {usual.patterns.begin(), usual.patterns.end()});
  for (const Mover& joint : movers(record, all)) {
    const std::string name = joint_in(joint.signal.info.name);
    if (joint.range() > 0)
      wish(name + ", commanded and measured", {"control.*." + name + ".reference_rad", joint.signal.info.name});
  }
  for (const std::string& signal : check_signals) {
    const auto shown = [&](const PanelWish& one) {
      return std::ranges::any_of(one.signals, [&](const ChosenSignal& s) { return s.info.name == signal; });
    };
    if (std::ranges::none_of(wishes, shown)) wish("of a check that failed", {signal});
  }
  return wishes;
}

void add_marks(const RunPage& page, SignalPlot& plot) {
  const RunResult& run = page.run.result;
  plot.marks.clear();  // the faults are taken from the run, because the record may lack them
  for (const RunFault& fault : run.faults) {
    const double share =
        static_cast<double>(fault.tick) / static_cast<double>(std::max<std::uint64_t>(run.control_ticks, 1));
    plot.marks.push_back({share * run.duration_s, fault_name(fault.told)});
  }
  for (const ScenarioPush& push : page.scenario.pushes)
    plot.marks.push_back({push.at_s, "push on " + push.link.name, false});
  std::erase_if(plot.marks, [&](const PlotMark& mark) { return mark.time_s > plot.to_s; });
  std::ranges::stable_sort(plot.marks, {}, &PlotMark::time_s);
}

// True when all values are 0 (no error, no contact), so that the panel shows nothing.
bool is_zero(const PlotPanel& panel) {
  return std::ranges::all_of(panel.lines, [](const PlotLine& line) {
    return std::ranges::all_of(line.points, [](const PlotPoint& point) { return point.y == 0; });
  });
}

}  // namespace

fs::path write_run_page(const RunPage& page, const ReportOptions& place) {
  HtmlReport report{.run = page.run,
                    .scenario = page.name,
                    .doc = page.scenario.doc,
                    .robot = page.robot,
                    .program = std::string("kadans ") + version};
  add_plot(page, report);
  add_film(page, place, report);
  const fs::path file = fs::path(place.folder) / report_file(page.name, page.run.result.seed);
  write_output_file(file, html_report(report));
  return file;
}

SignalPlot run_plot(const RecordOutline& record, const RunPage& page) {
  SignalPlot plot = plot_of(record, wishes_of(record, page.check_signals), {}, 300);
  std::erase_if(plot.panels, is_zero);
  add_marks(page, plot);
  return plot;
}

}  // namespace kadans
