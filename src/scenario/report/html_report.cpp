
#include "html_report.h"

#include <algorithm>
#include <cstdint>

#include "signal/number_text.h"
#include "telemetry/plot.h"
#include "telemetry/reading/record_rows.h"

namespace kadans {
namespace {

constexpr const char* page_style = R"css(
:root { color-scheme: light dark; --paper: #fefefe; --ink: #1c2833; --dim: #5b6875; --line: #d9e0e6; --card: #f4f6f8;
  --good: #1b7a3d; --bad: #c62828; --warn: #96690a; }
@media (prefers-color-scheme: dark) { :root { --paper: #12181e; --ink: #dde5ec; --dim: #93a1af; --line: #2a343e;
  --card: #1a222a; --good: #5cc98a; --bad: #ff8a80; --warn: #e0b252; } }
* { box-sizing: border-box; }
body { margin: 0 auto; padding: 28px 24px 64px; max-width: 1248px; background: var(--paper); color: var(--ink);
  font: 15px/1.5 system-ui, "DejaVu Sans", sans-serif; }
h1 { font-size: 26px; margin: 0 0 4px; } h2 { font-size: 18px; margin: 36px 0 10px; }
p { margin: 0 0 10px; max-width: 80ch; } .dim { color: var(--dim); }
.good { color: var(--good); } .bad { color: var(--bad); } .warn { color: var(--warn); }
.badge { display: inline-block; padding: 1px 12px; border: 2px solid; border-radius: 6px; font-weight: 700;
  letter-spacing: .04em; font-size: 18px; margin-right: 12px; vertical-align: 3px; }
table { border-collapse: collapse; } th { text-align: left; color: var(--dim); font-weight: 600; }
th, td { padding: 3px 18px 3px 0; border-bottom: 1px solid var(--line); vertical-align: top; }
td.number, th.number { text-align: right; font-variant-numeric: tabular-nums; white-space: nowrap; }
td.mark { width: 1.6em; font-weight: 700; }
.scroll { overflow-x: auto; max-height: 480px; overflow-y: auto; }
code, pre { font: 13px/1.5 ui-monospace, "DejaVu Sans Mono", monospace; }
pre { background: var(--card); padding: 10px 14px; border-radius: 6px; overflow-x: auto; margin: 0 0 10px;
  white-space: pre-wrap; overflow-wrap: anywhere; }
dl { display: grid; grid-template-columns: repeat(auto-fill, minmax(190px, 1fr)); gap: 10px 24px; margin: 18px 0; }
dt { color: var(--dim); font-size: 13px; } dd { margin: 0; font-variant-numeric: tabular-nums; overflow-wrap: anywhere; }
.film { display: grid; grid-template-columns: repeat(auto-fill, minmax(260px, 1fr)); gap: 12px; }
figure { margin: 0; } figcaption { color: var(--dim); font-size: 13px; } figure img { width: 100%; border-radius: 6px;
  border: 1px solid var(--line); }
.plot { overflow-x: auto; margin-bottom: 12px; } .plot svg { display: block; max-width: 100%; height: auto; min-width: 760px; }
.failed { border-left: 4px solid var(--bad); padding: 2px 0 2px 14px; margin: 0 0 14px; }
a { color: inherit; }
)css";

}  // namespace

std::string base64(std::string_view bytes) {
  constexpr std::string_view letters = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  for (std::size_t at = 0; at < bytes.size(); at += 3) {
    std::uint32_t three = 0;
    for (std::size_t i = 0; i < 3; ++i)
      three = three << 8U | (at + i < bytes.size() ? static_cast<unsigned char>(bytes[at + i]) : 0U);
    for (std::size_t i = 0; i < 4; ++i) text += at + i > bytes.size() ? '=' : letters[three >> (18 - 6 * i) & 63U];
  }
  return text;
}

std::string html_page(const std::string& title, const std::string& body, const std::string& style) {
  return "<!doctype html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
         "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n"
         "<link rel=\"icon\" href=\"data:,\">\n<title>" +
         html_text(title) + "</title>\n<style>" + page_style + style + "</style>\n</head>\n<body>\n" + body +
         "</body>\n</html>\n";
}

namespace {

std::string counted(std::size_t count, const char* what) {
  return (count == 0 ? "no" : std::to_string(count)) + " " + what + (count == 1 ? "" : "s");
}

std::string cell(const std::string& text, const char* type = "") {
  return "<td" + std::string(type) + ">" + html_text(text) + "</td>";
}
constexpr const char* number = " class=\"number\"";

// A small line on its own scale, for what a failed check saw.
std::string spark_line(const EvidenceTrace& trace) {
  const Plot plot{.x = {.range = {trace.from_s, trace.to_s}},
                  .lines = {plot_line("", trace.values, trace.from_s, trace.to_s)}};
  const PlotRange range = range_of(plot.lines);
  if (!(range.low <= range.high)) return "";
  return plot_svg(plot, {.width = 520, .height = 82, .left = 0, .top = 4, .right = 0, .bottom = 4}) + "<figcaption>" +
         html_text(trace.signal + (trace.unit.empty() ? "" : ", " + trace.unit)) +
         printed(": from %.4g to %.4g, between %.2f and %.2f s", range.low, range.high, trace.from_s, trace.to_s) +
         "</figcaption>";
}

class HtmlRun {
 public:
  explicit HtmlRun(const HtmlReport& report) : report_(report), run_(report.run.result) {}

  std::string write() {
    head();
    words();
    failures();
    plot();
    film();
    checks();
    transitions();
    faults();
    log();
    again();
    return html_page(report_.scenario + ": " + verdict(), text_, report_.plot_style);
  }

 private:
  std::string verdict() const {
    if (run_.interrupted) return "interrupted";
    return run_.passed ? "passed" : "failed";
  }
  std::size_t failed() const {
    return static_cast<std::size_t>(std::ranges::count(run_.checks, false, &CheckResult::passed));
  }
  double fault_s(const Fault& fault) const {
    if (run_.control_ticks == 0) return 0;
    return run_.duration_s * static_cast<double>(fault.tick) / static_cast<double>(run_.control_ticks);
  }
  void add(const std::string& html) { text_ += html; }
  void title(const std::string& text) { add("<h2>" + html_text(text) + "</h2>\n"); }

  void head() {
    const std::string color = run_.passed && !run_.interrupted ? "good" : "bad";
    std::string word = verdict();
    std::ranges::transform(word, word.begin(), [](char c) { return static_cast<char>(c - 'a' + 'A'); });
    add("<h1><span class=\"badge " + color + "\">" + word + "</span>" + html_text(report_.scenario) + "</h1>\n");
    if (!report_.doc.empty()) add("<p>" + html_text(report_.doc) + "</p>\n");
  }

  void fact(const char* name, const std::string& value) {
    add(std::string("<div><dt>") + name + "</dt><dd>" + html_text(value) + "</dd></div>\n");
  }

  void words() {
    const std::vector<LogLine>& lines = report_.run.log.lines();
    const auto errors =
        static_cast<std::size_t>(std::ranges::count(lines, BehaviorLog::Severity::error, &LogLine::severity));
    add("<p>" + html_text(report_.robot) + " ran " + html_text(report_.scenario) +
        printed(" with seed %llu for %.4g simulated seconds", static_cast<unsigned long long>(run_.seed),
                run_.duration_s) +
        ": " + counted(report_.run.log.transitions().size(), "transition") + ", " +
        counted(run_.faults.size(), "fault") + ", " + counted(errors, "error") + " of behaviors. " +
        (failed() > 0
             ? printed("%zu of %zu checks did not hold.", failed(), run_.checks.size())
             : "Checks that held: " + (run_.checks.empty() ? "none, there are none."
                                                           : "all " + std::to_string(run_.checks.size()) + ".")) +
        "</p>\n");
    if (!run_.error.empty()) add("<p class=\"bad\">The run ended early: " + html_text(run_.error) + "</p>\n");
    add("<dl>\n");
    fact("robot", report_.robot);
    fact("seed", std::to_string(run_.seed));
    fact("simulated", printed("%.3f s", run_.duration_s));
    fact("took", printed("%.2f s, %.1f times real time", run_.wall_s, run_.realtime_factor));
    fact("control tick", printed("median %.2f us, 99 %% %.2f us, most %.0f us", 1e-3 * run_.tick.median_ns,
                                 1e-3 * run_.tick.p99_ns, 1e-3 * run_.tick.max_ns));
    fact("ticks", printed("%llu control, %llu behavior", static_cast<unsigned long long>(run_.control_ticks),
                          static_cast<unsigned long long>(run_.behavior_ticks)));
    fact("commands", printed("%llu sent, %llu refused", static_cast<unsigned long long>(run_.commands_sent),
                             static_cast<unsigned long long>(run_.commands_refused)));
    fact("state", hash_text(run_.state_hash));
    fact("program", report_.program);
    if (!report_.run.record.empty()) fact("record", report_.run.record);
    add("</dl>\n");
    if (report_.run.quantities.empty()) return;
    const std::string drawn = listed(report_.run.quantities, [](const QuantityValue& quantity) {
      return quantity.name + printed(" = %.6g", quantity.value);
    });
    add("<p class=\"dim\">Set or drawn for this run: " + html_text(drawn) + "</p>\n");
  }

  void failures() {
    if (failed() == 0) return;
    title("What failed");
    for (const CheckResult& check : run_.checks) {
      if (check.passed) continue;
      add("<div class=\"failed\"><strong>" + html_text(check.name) +
          "</strong>: " + printed("%.5g at %.3f s", check.value, check.at_s) + html_text(wanted_clause(check)));
      for (const EvidenceTrace& trace : report_.run.evidence) {
        if (trace.check == check.name) add("<figure>" + spark_line(trace) + "</figure>");
      }
      add("</div>\n");
    }
  }

  void plot() {
    title("What the robot did");
    if (report_.plot.empty()) return add("<p class=\"dim\">No plots: " + html_text(report_.no_plot) + "</p>\n");
    const std::size_t begin = report_.plot.find("<svg");  // without the declaration of XML
    add("<div class=\"plot\">" + (begin == std::string::npos ? "" : report_.plot.substr(begin)) + "</div>\n");
  }

  void film() {
    title("Film");
    if (report_.film.empty()) return add("<p class=\"dim\">No pictures: " + html_text(report_.no_film) + "</p>\n");
    add("<div class=\"film\">\n");
    for (const ReportPicture& picture : report_.film) {
      const std::string time = printed("%.2f s", picture.time_s);
      add("<figure><img alt=\"the robot at " + time + "\" src=\"data:image/png;base64," + base64(picture.png) +
          "\"><figcaption>" + time + "</figcaption></figure>\n");
    }
    add("</div>\n");
  }

  void table(const std::vector<const char*>& heads, std::size_t numbers_first) {
    add("<div class=\"scroll\"><table><tr>");
    for (std::size_t i = 0; i < heads.size(); ++i)
      add(std::string("<th") + (i < numbers_first ? number : "") + ">" + heads[i] + "</th>");
    add("</tr>\n");
  }

  void checks() {
    title("Checks");
    if (run_.checks.empty()) return add("<p class=\"dim\">The scenario has none.</p>\n");
    table({"", "check", "value", "when", "wanted"}, 0);
    for (const CheckResult& check : run_.checks) {
      add("<tr>" + std::string(check.passed ? "<td class=\"mark good\">✓</td>" : "<td class=\"mark bad\">✗</td>") +
          cell(check.name) + cell(printed("%.5g", check.value), number) + cell(printed("%.3f s", check.at_s), number) +
          cell(demand(check)) + "</tr>\n");
    }
    add("</table></div>\n");
  }

  void transitions() {
    title("Transitions");
    const std::vector<Transition>& all = report_.run.log.transitions();
    for (const auto& [behavior, active] : report_.run.log.active().by_behavior())
      add("<p>At the end " + html_text(behavior) + " was in " + html_text(listed(active)) + ".</p>\n");
    if (all.empty()) return add("<p class=\"dim\">None.</p>\n");
    table({"time", "behavior", "from", "to", "why"}, 1);
    for (const Transition& t : all)
      add("<tr>" + cell(printed("%.3f s", seconds(t.time_ns)), number) + cell(t.behavior) + cell(t.from) + cell(t.to) +
          cell(t.why) + "</tr>\n");
    add("</table></div>\n");
  }

  void faults() {
    title("Faults");
    if (run_.faults.empty()) return add("<p class=\"dim\">None.</p>\n");
    table({"time", "fault", "joint", "what", "set by"}, 1);
    for (const RunFault& fault : run_.faults) {
      add("<tr>" + cell(printed("%.3f s", fault_s(fault)), number) + cell(fault.told.name) + cell(fault.told.joint) +
          cell(fault_detail(fault.told)) + cell(configuration_key(fault.code)) + "</tr>\n");
    }
    add("</table></div>\n");
  }

  void log() {
    title("Log");
    const std::vector<LogLine>& lines = report_.run.log.lines();
    if (lines.empty()) return add("<p class=\"dim\">The behaviors said nothing.</p>\n");
    table({"time", "", "who", "what"}, 1);
    for (const LogLine& line : lines) {
      const bool error = line.severity == BehaviorLog::Severity::error;
      const bool warning = line.severity == BehaviorLog::Severity::warning;
      add("<tr>" + cell(printed("%.3f s", seconds(line.time_ns)), number) +
          cell(error     ? "error"
               : warning ? "warning"
                         : "",
               error ? " class=\"bad\"" : " class=\"warn\"") +
          cell(line.behavior) + cell(line.text) + "</tr>\n");
    }
    add("</table></div>\n");
  }

  void again() {
    title("Once more");
    add("<pre>" + html_text(report_.run.repeat) + "</pre>\n");
    if (!report_.run.record.empty())
      add("<p class=\"dim\">To look at it: <code>kadans view " + html_text(report_.run.record) + "</code></p>\n");
  }

  const HtmlReport& report_;
  const RunResult& run_;
  std::string text_;
};

}  // namespace

std::string html_report(const HtmlReport& report) { return HtmlRun(report).write(); }

std::string report_file(const std::string& name, std::uint64_t seed) {
  std::string safe = name;
  const auto plain = [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' || c == '-';
  };
  std::ranges::replace_if(
      safe, [&](char c) { return !plain(c); }, '_');
  return safe + "-" + std::to_string(seed) + ".html";
}

}  // namespace kadans
