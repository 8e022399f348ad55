#include "run_page.h"

#include <algorithm>

#include "app/live/record_pictures.h"
#include "campaign/work/durable_file.h"
#include "run_plot.h"
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
  if (place.film == "failed" && page.subject.result.passed)
    report.no_film = "the run passed; --film always draws them all the same";
  const double duration_s = page.subject.result.duration_s;
  if (report.no_film.empty()) report.no_film = pictures_missing();
  if (report.no_film.empty() && !(duration_s > 0)) report.no_film = "the run has no duration";
  if (!report.no_film.empty()) return;
  try {
    const PictureOrder order{
        .record = page.record, .every_s = duration_s / (pictures - 0.5), .width = 480, .height = 360};
    draw_record(order, [&report](const std::string& name, std::string bytes) {
      report.film.push_back({std::stod(name), std::move(bytes)});
    });
  } catch (const InputError& error) {
    report.no_film = error.what();
  }
}

}  // namespace

fs::path write_run_page(const RunPage& page, const ReportOptions& place) {
  HtmlReport report{.subject = page.subject,
                    .scenario = page.name,
                    .doc = page.scenario.doc,
                    .robot = page.subject.model.name,
                    .program = std::string("kadans ") + version,
                    .quantities = page.quantities,
                    .evidence = page.evidence,
                    .plot = {},
                    .no_plot = {},
                    .plot_style = {},
                    .film = {},
                    .no_film = {}};
  add_plot(page, report);
  add_film(page, place, report);
  std::error_code error;
  fs::create_directories(place.folder, error);
  if (error) throw InputError({.file = place.folder, .message = "cannot be made: " + error.message()});
  const fs::path file = fs::path(place.folder) / report_file(page.name, page.subject.result.seed);
  write_durably(file, html_report(report));
  return file;
}

}  // namespace kadans
