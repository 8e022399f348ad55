// What plays and where it is, as bytes, and how another process's host goes on there: first the files, as soon as it is
// made, then, in its first tick, where each behavior was.
#include "kadans/signal/input_error.h"
#include "play_order_bytes.h"
#include "script_host.h"
#include "signal/byte_order.h"

namespace kadans {
namespace {

constexpr std::uint32_t kept_format = 1;

}  // namespace

std::string ScriptHost::keep(ByteWriter& bytes, std::int64_t time_ns) {
  bytes.put(kept_format);
  bytes.put(static_cast<std::uint32_t>(list_.entries().size()));
  for (const PlayList::Entry& entry : list_.entries()) {
    const Behavior::Settings& settings = entry.behavior->settings();
    put_item({.file = settings.file, .lane = entry.lane, .arguments = settings.arguments, .source = settings.source},
             bytes);
    bytes.put<std::uint8_t>(entry.lasting);
  }
  bytes.put(static_cast<std::uint32_t>(events_done_));
  bytes.put(list_.status().done.load(std::memory_order_relaxed));
  bytes.put(list_.status().not_done.load(std::memory_order_relaxed));
  pause_.keep(bytes, time_ns);
  safe_.keep(bytes);
  std::string why;
  for (const PlayList::Entry& entry : list_.entries()) {
    bytes.put<std::uint8_t>(entry.over);
    const std::string its = entry.over ? "" : entry.behavior->keep(bytes);
    if (why.empty() && !its.empty()) why = entry.behavior->name() + ": " + its;
  }
  return why;
}

std::vector<PlayList::Entry> ScriptHost::load_kept(std::vector<InputProblem>& problems) {
  ByteReader bytes(settings_.kept);
  std::vector<PlayItem> items;
  std::vector<bool> lasting;
  const bool known = bytes.take<std::uint32_t>() == kept_format;
  for (auto left = bytes.take<std::uint32_t>(); left > 0 && known && bytes.ok(); --left) {
    items.push_back(take_item(bytes));
    lasting.push_back(bytes.take<std::uint8_t>() != 0);
  }
  if (!known || !bytes.ok()) problems.push_back({.message = "what was kept of the behaviors cannot be read"});
  std::vector<PlayList::Entry> loaded;
  if (problems.empty()) loaded = load(items, true, problems);
  for (std::size_t i = 0; i < loaded.size(); ++i) loaded[i].lasting = lasting[i];
  settings_.kept = settings_.kept.last(bytes.left());
  return loaded;
}

void ScriptHost::go_on(const Snapshot& snapshot, CommandSender& commands) noexcept {
  ByteReader bytes(settings_.kept);
  settings_.kept = {};
  events_done_ = std::min<std::size_t>(bytes.take<std::uint32_t>(), events_.size());
  const auto done = bytes.take<std::uint32_t>();
  list_.count(done, bytes.take<std::uint32_t>());
  pause_.restore(bytes);
  safe_.restore(bytes);
  for (PlayList::Entry& entry : list_.entries()) {
    entry.over = bytes.take<std::uint8_t>() != 0;
    if (entry.over) continue;
    entry.behavior->hold_clock(pause_.held_ns());
    if (!entry.behavior->go_on(bytes, snapshot, commands)) {
      lost_ = entry.behavior->name() + ": " + entry.behavior->error().text();
      return;
    }
  }
  if (!bytes.ok() || bytes.left() > 0) lost_ = "what was kept of the behaviors cannot be read";
}

}  // namespace kadans
