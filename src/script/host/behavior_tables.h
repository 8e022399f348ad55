// What people ask of the behaviors that play, between two ticks: their tables (states, results, parameters, events),
// why their transitions wait, their charts, and a change of a parameter. A host in a thread replies at once, one in a
// process of its own with its next answer; the reply is the same. As bytes they, and the orders to what plays, cross
// between processes.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "config/scenario/play_item.h"
#include "script/behavior/behavior_why.h"
#include "script_declarations.h"

namespace kadans {

class ByteReader;
class ByteWriter;

struct BehaviorReport {
  std::string name, outcome, error;
  std::string result{};               // with the outcome
  std::vector<std::string> active{};  // all innermost active states, by path
  std::uint32_t lane = 0;
  bool over = false;
  std::uint64_t chart = 0;  // a number that changes when the chart's states or transitions change
  std::vector<ScriptParameter> parameters{};
  std::vector<ScriptEvent> events{};  // that it takes now
};

struct BehaviorQuestion {
  enum class Kind : std::uint8_t {
    report,         // BehaviorReply::behaviors, paused
    why,            // BehaviorReply::reasons; `text` = name of a behavior, "": all that play
    describe,       // BehaviorReply::text = their charts for viewers, as JSON
    set_parameter,  // `text` = BEHAVIOR.NAME, `value`; BehaviorReply::before, chunk
    reload,         // of decisions: their files are read again; BehaviorReply::text = what came of it
  };
  Kind kind = Kind::report;
  std::string text{};
  double value = 0;
};

struct BehaviorReply {
  std::string error{};  // why not; "": it was done
  bool paused = false;
  std::vector<BehaviorReport> behaviors{};
  std::vector<BehaviorReasons> reasons{};
  std::string text{};
  double before = 0;    // value of the parameter
  std::string chunk{};  // the file that declares it
};

void put_question(const BehaviorQuestion& question, ByteWriter& bytes);
void put_reply(const BehaviorReply& reply, ByteWriter& bytes);
// Of bytes that another process wrote: what is missing or unknown is read as zero or empty, then the reader is not ok()
// or `false` is returned.
[[nodiscard]] bool take_question(ByteReader& bytes, BehaviorQuestion& question);
[[nodiscard]] bool take_reply(ByteReader& bytes, BehaviorReply& reply);

// Orders and items of the play list: a missing value is read as zero or empty, and then the reader is not ok(). An
// order's kind may be none that there is.
void put_item(const PlayItem& item, ByteWriter& bytes);
void put_event(const PlayedEvent& event, ByteWriter& bytes);
void put_order(const PlayOrder& order, ByteWriter& bytes);
PlayItem take_item(ByteReader& bytes);
PlayedEvent take_event(ByteReader& bytes);
PlayOrder take_order(ByteReader& bytes);

}  // namespace kadans
