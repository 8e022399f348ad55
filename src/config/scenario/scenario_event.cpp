#include "scenario_event.h"

#include "config/robot/project_root.h"

namespace kadans {
namespace {

constexpr double time_max_s = 1e6;

// Which of the other fields an event has to have.
struct Wants {
  bool list = false, reload = false;
};

void verify(const Fields& f, const ScenarioEvent& event, Wants wants, Problems& problems) {
  const std::string& kind = play_order_names[static_cast<std::size_t>(event.order.kind)];
  const auto field = [&](const char* name, bool wanted) {
    if (wanted && !f.has(name)) problems.add(f.place(), f.path(name) + " is missing: to " + kind + " needs it");
    if (!wanted && f.has(name))
      problems.add(f.place(name), f.path(name) + " means nothing here: to " + kind + " has none");
  };
  field("list", wants.list);
  field("behavior", wants.reload);
  field("file", wants.reload);
}

}  // namespace

void event_fields(Fields& f, ScenarioEvent& event, const PlayFolders& folders, Problems& problems) {
  std::string list, file;
  PlayOrder& order = event.order;
  f.number("at_s", event.at_s, {0, time_max_s, "s"}, "when", Need::required);
  const bool known = f.choice("do", order.kind, play_order_names, "what happens to what plays", Need::required);
  f.string("list", list, "play, replace: what to play, \"squat{depth_m=0.08}, wave\"");
  f.string("behavior", order.behavior.name, "reload: name of a behavior that plays");
  f.string("file", file, "reload: what it goes on with, from the project root");
  if (!f.reading() || !known) return;
  using Kind = PlayOrder::Kind;
  verify(f, event, {order.kind == Kind::play || order.kind == Kind::replace, order.kind == Kind::reload}, problems);
  order.behavior.place = f.place("behavior");
  if (!file.empty()) order.file = resolve_file(file, f.place("file"), "reload", problems);
  if (list.empty()) return;
  TextPlace start = f.place("list");
  ++start.column;  // behind the quote
  order.list = read_play_items(list, start, folders, problems);
}

}  // namespace kadans
