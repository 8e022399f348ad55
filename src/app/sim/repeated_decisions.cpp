#include "repeated_decisions.h"

#include <algorithm>
#include <exception>
#include <memory>
#include <utility>

#include "config/scenario/event_text.h"
#include "engine/tick/seen_entries.h"
#include "script/host/behavior_tables.h"
#include "signal/byte_order.h"
#include "signal/number_text.h"
#include "telemetry/record/input_stream.h"

namespace kadans {
namespace {

std::string order_text(const PlayOrder& order) {
  const auto kind = static_cast<std::size_t>(order.kind);
  std::string text = kind < play_order_names.size() ? play_order_names[kind] : "?";
  for (const PlayItem& item : order.list)
    text += " " + item.file.stem().string() + (item.arguments.empty() ? "" : data_json(item.arguments));
  if (!order.behavior.name.empty()) text += " " + order.behavior.name;
  return order.event.name.empty() ? text : text + " " + event_text(order.event);
}

// What a tick of them asks for, line by line. Files are other ones here than they were there, so their names count.
std::vector<std::string> lines_of(bool failed, const Decider::Decided& decided) {
  std::vector<std::string> lines;
  for (const PlayOrder& order : decided.orders) lines.push_back(order_text(order));
  for (const PlayedEvent& message : decided.messages) lines.push_back("send " + event_text(message));
  if (failed) lines.emplace_back("an error");
  return lines;
}

}  // namespace

RepeatedDecisions::RepeatedDecisions(const std::string& record, Supervisor& supervisor,
                                     std::function<void(const BehaviorInput&)> write_file)
    : supervisor_(supervisor),
      decisions_(*supervisor.decisions()),
      write_file_(std::move(write_file)),
      reader_(record, false, decision_inputs_topic) {
  supervisor_.take_inputs_by(this);
}

void RepeatedDecisions::repeat(const Snapshot& newest) {
  const std::uint64_t shown = newest.time_ns == 0 ? 0 : newest.tick + 1;
  while (parting_.empty()) {
    waits_ = waits_ || tick_.read(reader_);
    if (!waits_ || tick_.snapshot() > shown) return;
    repeat_tick(newest);
    waits_ = false;
  }
}

void RepeatedDecisions::repeat_tick(const Snapshot& newest) {
  copy_used(newest, snapshot_);
  looks_ = 0;
  for (const BehaviorInput& input : tick_.inputs()) write_file_(input);
  for (std::size_t i = 0; i < tick_.inputs().size(); ++i) {
    const BehaviorInput& input = tick_.inputs()[i];
    if (input.kind != BehaviorInput::Kind::asked) continue;
    tick_.turn_to(i);
    take(input);
  }
}

void RepeatedDecisions::take(const BehaviorInput& input) {
  looks_ = 0;  // as when it was recorded
  ByteReader bytes(input.bytes);
  switch (input.how) {
    case Asked::seen: {
      SeenEntries seen;
      if (!take_seen(input.bytes, seen)) return part("what they saw of the world is damaged");
      show_seen(seen, snapshot_.status.odometry, snapshot_.time_ns, snapshot_.seen);
      break;
    }
    case Asked::plays:
      if (!take_report(input.bytes, report_)) return part("what they knew of what plays is damaged");
      break;
    case Asked::reload:
      decisions_.reload(snapshot_);
      break;
    case Asked::heard: {
      PlayedEvent event = take_event(bytes);
      if (!bytes.ok() || !out_of_bounds(event.data).empty()) return part("a message that they heard is damaged");
      decisions_.hear(std::move(event));
      break;
    }
    case Asked::question: {
      auto question = std::make_unique<DecisionQuestion>();
      if (!take_question(bytes, question->question)) return part("a question to them is damaged");
      decisions_.ask(std::move(question), snapshot_);
      break;
    }
    case Asked::taken_over:
      take_over();
      break;
    case Asked::decided:
      (void)decisions_.tick(snapshot_, report_);
      ++ticks_;
      compare(input.bytes);
      decisions_.decided() = {};
      break;
    case Asked::order:
    case Asked::note:
      break;  // of behaviors
  }
}

// Another process went on from what the last one left, which is what is here.
void RepeatedDecisions::take_over() {
  try {
    const std::string why = decisions_.take_over(snapshot_, ticks_ == 0);
    if (!why.empty()) part("they cannot go on as another process: " + why);
  } catch (const std::exception& error) {
    part(std::string("they cannot go on as another process: ") + error.what());
  }
}

void RepeatedDecisions::compare(std::span<const std::byte> recorded) {
  ByteReader bytes(recorded);
  bool failed = false;
  Decider::Decided then;
  if (!take_decided(bytes, failed, then)) return part("what they asked for is damaged");
  const std::vector<std::string> now_lines = lines_of(decisions_.failed(), decisions_.decided()),
                                 then_lines = lines_of(failed, then);
  const auto [now, was] = std::ranges::mismatch(now_lines, then_lines);
  const auto line = [](const auto& at, const auto& end) { return at == end ? std::string("nothing more") : *at; };
  if (now == now_lines.end() && was == then_lines.end()) return;
  const std::string error = decisions_.failed() ? " (" + decisions_.behavior().error().text() + ")" : "";
  part("they ask for " + line(now, now_lines.end()) + error + ", recorded was " + line(was, then_lines.end()));
}

void RepeatedDecisions::part(const std::string& what) {
  if (parting_.empty())
    parting_ = printed("at %.3f s, of the decisions: ", 1e-9 * static_cast<double>(snapshot_.time_ns)) + what;
}

}  // namespace kadans
