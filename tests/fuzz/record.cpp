// Records that somebody sends, read in every way that `kadans log` has: as messages and JSON lines; then, in turn by
// the size of the input, compared, cut, or as tables and pictures. Each line is JSON, what is cut is a whole record,
// and a record is as itself.
#include <nlohmann/json.hpp>

#include "fuzz_input.h"
#include "telemetry/plot/signal_plot.h"
#include "telemetry/reading/record_comparison.h"
#include "telemetry/reading/record_export.h"

namespace {

using namespace kadans;
using fuzz::require;

std::uint64_t read_messages(const std::string& path) {
  RecordRows rows(path);
  std::uint64_t count = 0;
  for (; rows.next(); ++count) {
    require(rows.values().empty() || rows.values().size() == rows.topic().signals.size(), "a row has all its signals");
    (void)event_in(rows.topic(), rows.text(), rows.time_ns());
    if (const auto fault = fault_in(rows.topic(), rows.text(), rows.time_ns())) (void)fault_text(*fault);
  }
  require(rows.reader().complete() == rows.reader().problem().empty(),
          "a record is whole, or it is said what is wrong");
  return count;
}

void read_lines(const std::string& path, std::uint64_t messages) {
  JsonLines lines(path, {}, {});
  std::string line;
  while (lines.next(line))
    require(nlohmann::json::accept(line) && line.find('\n') == std::string::npos, "a line is JSON");
  require(lines.lines() == messages, "each message has a line");
}

void draw_signals(const RecordOutline& outline, const std::string& path) {
  const std::vector<ChosenSignal> signals = choose_signals(outline, {});
  CsvLines table(path, signals, {});
  for (std::string line; table.next(line);) {
  }
  const SignalPlot plot = plot_of(outline, panels_by_unit(signals), {}, 20);
  for (const PlotPanel& panel : plot.panels) {
    for (const PlotLine& drawn : panel.lines) require(drawn.points.size() <= 4 * 21 * 2, "a picture is bounded");
  }
  (void)gnuplot_script(plot, PlotFormat::svg);
}

void cut(const RecordOutline& outline) {
  const fuzz::MemoryFile file;
  const CutRecord cut =
      cut_record(outline, {.span = {.from_ns = outline.first_ns, .to_ns = outline.last_ns}}, file.path());
  const RecordOutline again = outline_of(file.path());
  require(again.complete, "what is cut is whole");
  require(again.file_bytes == cut.file_bytes, "what is cut is told");
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const fuzz::MemoryFile file({reinterpret_cast<const char*>(data), size});
  const std::string path = file.path();
  try {
    read_lines(path, read_messages(path));
    const RecordOutline outline = outline_of(path);
    switch (size % 3) {
      case 0:
        require(diff_records(outline, outline, 0).same(), "a record is as itself");
        require(differing_facts(outline, outline).empty(), "a run is as itself");
        break;
      case 1:
        cut(outline);
        break;
      default:
        if (!outline.signal_names().empty()) draw_signals(outline, path);
    }
  } catch (const InputError&) {  // no record, or one that says nothing
  }
  return 0;
}
