// What cannot be meant in how a script goes on: loops that never end, motions that are replaced before they begin, keys
// that stand twice in a table, and values that a reload loses.
#include <algorithm>
#include <cstdlib>
#include <map>
#include <optional>
#include <set>

#include "check_source.h"

namespace kadans {
namespace {

// Functions of Lua that end at once and change nothing.
bool is_pure(const std::string& name) {
  constexpr std::string_view pure[] = {"print",  "tostring", "tonumber", "ipairs", "pairs",
                                       "select", "type",     "unpack",   "math",   "string"};
  return std::ranges::find(pure, name) != std::end(pure);
}

// Where the condition of a `while` ends: at its `do`.
std::size_t do_of(const Tokens& tokens, std::size_t at) {
  for (int depth = 0; tokens[at].kind != TokenKind::end; ++at) {
    if (depth == 0 && tokens[at].is("do")) return at;
    depth += opens(tokens[at]);
  }
  return at;
}

class FlowCheck {
 public:
  FlowCheck(const Catalog& catalog, const KnownNames& known, bool of_behavior, const std::vector<SourceUse>& uses,
            const Tokens& tokens)
      : catalog_(catalog), known_(known), of_behavior_(of_behavior), tokens_(tokens) {
    for (const SourceUse& use : uses) {
      if (use.assigned) assigned_.insert(use.declared);
      uses_.emplace(use.at, use);
    }
  }

  Mistakes run() {
    for (std::size_t at = 0; at + 4 < tokens_.size() && tokens_[at].kind != TokenKind::end; ++at) {
      enter_token(at);
      const SourceUse* const use = use_at(at);
      if (use == nullptr) continue;
      local_of_file(*use);
      if (!is_move(*use)) continue;
      replaced(*use);
      begun_anew(*use);
    }
    return std::move(found_);
  }

 private:
  enum class Call { harmless, waits, unknown };
  struct Body {
    bool waits = false, unknown = false, leaves = false;
  };
  struct Loop {
    std::size_t condition = 0, condition_end = 0, body = 0, body_end = 0;
    bool until = false;
    std::set<std::size_t> assigned;  // the names that get a value in the body, by the tokens that declare them
    bool assigns_field = false;
  };
  struct Block {
    std::size_t token = 0;
    bool returns = false;             // there was a `return` in it or in a block inside it
    std::map<std::string, int> keys;  // of a table: their lines
  };

  void tell(int line, std::string text) { found_.push_back({line, std::move(text)}); }

  const SourceUse* use_at(std::size_t at) const {
    const auto found = uses_.find(at);
    return found == uses_.end() ? nullptr : &found->second;
  }

  Call kind_of(const SourceUse& use) const {
    const auto& path = use.meaning.path;
    if (!use.known) return is_pure(use.name) ? Call::harmless : Call::unknown;
    switch (use.meaning.role) {
      case SourceRole::module:
        return !path.empty() && (path[0] == "log" || path[0] == "pose") ? Call::harmless : Call::unknown;
      case SourceRole::motion:
        return path.empty() && use.method == "cancel" ? Call::harmless : Call::waits;
      case SourceRole::machine:
        break;
      default:
        return Call::unknown;
    }
    if (path.empty()) {
      const bool asks = use.method == "emit" || use.method == "clear_faults" || use.method == "reset_odometry";
      return asks ? Call::harmless : Call::waits;
    }
    if (path.size() != 1 || use.method.empty()) return Call::unknown;
    const std::size_t after = end_of_call(tokens_, use.arguments);
    return tokens_[after].is(":") ? Call::waits : Call::harmless;  // move(...):wait()
  }

  // What a piece of text may do beside going on. A function in it may do anything.
  Body body_of(std::size_t from, std::size_t to) const {
    Body body;
    for (std::size_t i = from; i < to; ++i) {
      const SourceToken& token = tokens_[i];
      body.unknown = body.unknown || token.is("function");
      body.leaves = body.leaves || token.is_any({"break", "return", "goto"});
      const bool of_value = i > 0 && tokens_[i - 1].is_any({")", "]"});
      if (of_value && (token.is("(") || token.is("{") || token.is(":") || token.kind == TokenKind::text))
        (token.is(":") && tokens_[i + 1].text == "wait" ? body.waits : body.unknown) = true;
      const SourceUse* const use = use_at(i);
      if (use == nullptr) continue;
      const Call call = use->arguments == 0 ? Call::harmless : kind_of(*use);
      body.waits = body.waits || call == Call::waits;
      body.unknown = body.unknown || call == Call::unknown;
      if (use->next > i) i = use->next - 1;
    }
    return body;
  }

  void note_assigned(Loop& loop) const {
    for (auto use = uses_.lower_bound(loop.body); use != uses_.end() && use->first < loop.body_end; ++use) {
      if (!use->second.assigned) continue;
      loop.assigned.insert(use->second.declared);
      loop.assigns_field = loop.assigns_field || use->second.written > 0;
    }
  }

  // Whether what is read has the same value for as long as the loop does not wait.
  bool stays(const SourceUse& use, const Loop& loop) const {
    const auto& path = use.meaning.path;
    if (!use.known || !use.method.empty() || use.arguments != 0) return false;
    if (use.declared >= loop.body && use.declared < loop.body_end) return false;
    if (use.written == 0) {
      return use.declared != 0 && use.meaning.role != SourceRole::table && !loop.assigned.contains(use.declared);
    }
    if (path.empty() || path.back() == "*") return false;
    if (use.meaning.role == SourceRole::snapshot || use.meaning.role == SourceRole::motion ||
        use.meaning.role == SourceRole::parameters)
      return true;
    if (use.meaning.role != SourceRole::machine) return false;
    if (path[0] == "time_s") return true;
    return path[0] == "vars" && path.size() == 2 && !loop.assigns_field;
  }

  bool never_changes(const Loop& loop) const {
    for (std::size_t i = loop.condition; i < loop.condition_end; ++i) {
      const SourceToken& token = tokens_[i];
      if (const SourceUse* const use = use_at(i)) {
        if (!stays(*use, loop)) return false;
        i = use->next - 1;
        continue;
      }
      const bool sign = token.is_any(
          {"and", "or", "not", "nil", "==", "~=", "<", ">", "<=", ">=", "+", "-", "*", "/", "(", ")", ".."});
      if (!token.is_literal() && !sign) return false;
    }
    const bool single = loop.condition_end == loop.condition + 1;
    const SourceToken& only = tokens_[loop.condition];
    return !single || (loop.until ? !only.is("true") : !only.is("false") && !only.is("nil"));
  }

  bool only_waits(const Loop& loop) const {
    std::size_t at = loop.body;
    while (at < loop.body_end) {
      const SourceUse* const use = use_at(at);
      const bool waits = use != nullptr && use->arguments != 0 && use->meaning.role == SourceRole::machine &&
                         use->meaning.path.empty() && use->method == "wait";
      if (!waits && !tokens_[at].is(";")) return false;
      at = waits ? end_of_call(tokens_, use->arguments) : at + 1;
    }
    return loop.body < loop.body_end;
  }

  // A local in the condition of a loop that only waits, when all names in the condition were read before the loop.
  const SourceUse* stale(const Loop& loop) const {
    const SourceUse* found = nullptr;
    for (std::size_t i = loop.condition; i < loop.condition_end; ++i) {
      const SourceUse* const use = use_at(i);
      if (use == nullptr) {
        if (tokens_[i].kind == TokenKind::name) return nullptr;
        continue;
      }
      const bool read = use->meaning.role == SourceRole::snapshot && use->meaning.path.size() > 1;
      const bool kept = use->declared != 0 && use->written == 0 && use->method.empty() && use->arguments == 0;
      if (!read || !kept || assigned_.contains(use->declared)) return nullptr;
      const KnownNames::Shape* shape = &known_.snapshot;  // a table of `s` is no copy
      for (const std::string& field : use->meaning.path) {
        const auto next = shape->fields.find(field);
        if (next == shape->fields.end()) return nullptr;
        shape = &next->second;
      }
      if (!shape->fields.empty() || shape->open) return nullptr;
      found = use;
      i = use->next - 1;
    }
    return found;
  }

  void loop(std::size_t head) {
    Loop loop;
    loop.until = tokens_[head].is("repeat");
    const std::size_t opens_at = loop.until ? head : do_of(tokens_, head + 1);
    loop.body = opens_at + 1;
    loop.body_end = end_of_block(tokens_, opens_at);
    loop.condition = loop.until ? loop.body_end + 1 : head + 1;
    loop.condition_end = loop.until ? values_of(tokens_, loop.condition).back() : opens_at;
    if (loop.condition >= loop.condition_end) return;
    const Body body = body_of(loop.body, loop.body_end);
    if (body.leaves) return;
    if (body.waits) {
      const SourceUse* const local = only_waits(loop) ? stale(loop) : nullptr;
      if (local == nullptr) return;
      std::string path = "s";
      for (const std::string& field : local->meaning.path) path += "." + field;
      return tell(local->line, "'" + local->name +
                                   "' was read before the loop and stays the same while it waits: ask " + path +
                                   " in the condition");
    }
    if (body.unknown) return;
    note_assigned(loop);
    if (!never_changes(loop)) return;
    tell(tokens_[head].line,
         "this loop never ends: nothing changes until it waits; in run write m:wait(0.01) into it, elsewhere let a "
         "transition wait");
  }

  bool is_move(const SourceUse& use) const {
    return use.meaning.role == SourceRole::machine && use.meaning.path.size() == 1 && use.arguments != 0 &&
           use.method == "move";
  }

  // The joints that a written pose moves; nothing when only the run knows them.
  std::optional<std::set<std::string>> joints_of(std::size_t pose, bool numbers_only) const {
    std::set<std::string> joints;
    if (tokens_[pose].kind == TokenKind::text && tokens_[pose + 1].is_any({",", ")"})) {
      for (const PoseInfo& known : catalog_.poses) {
        if (known.name != tokens_[pose].text || catalog_.model == nullptr) continue;
        for (const auto& [joint, ignored] : known.position_rad) joints.insert(catalog_.model->joints[joint].name);
        return joints;
      }
      return std::nullopt;
    }
    if (!tokens_[pose].is("{")) return std::nullopt;
    for (const std::size_t part : parts_of(tokens_, pose + 1)) {
      if (tokens_[part].kind != TokenKind::name || !tokens_[part + 1].is("=")) return std::nullopt;
      const std::size_t value = tokens_[part + 2].is("-") ? part + 3 : part + 2;
      const bool number = tokens_[value].kind == TokenKind::number && tokens_[value + 1].is_any({",", "}", ";"});
      if (numbers_only && !number) return std::nullopt;
      joints.insert(tokens_[part].text);
    }
    return joints;
  }

  // time_s in { time_s = 1 }; 0 when it is not written out.
  double time_of(std::size_t options) const {
    if (!tokens_[options].is("{")) return 0;
    double time_s = 0;
    for (const std::size_t part : parts_of(tokens_, options + 1)) {
      if (tokens_[part].text == "relative") return 0;
      if (tokens_[part].text == "time_s" && tokens_[part + 2].kind == TokenKind::number)
        time_s = std::strtod(tokens_[part + 2].text.c_str(), nullptr);
    }
    return time_s;
  }

  // The use with which the next statement begins, behind calls that are over at once.
  const SourceUse* next_statement(std::size_t at) const {
    for (;;) {
      if (tokens_[at].is(";")) {
        ++at;
        continue;
      }
      if (tokens_[at].is("local") && tokens_[at + 2].is("=")) at += 3;
      if (tokens_[at].kind == TokenKind::name && tokens_[at + 1].is("=")) at += 2;
      const SourceUse* const use = use_at(at);
      if (use == nullptr || use->arguments == 0 || is_move(*use)) return use;
      const bool gains = use->method == "set_gains" || use->method == "set_parameter" || use->method == "emit";
      if (!gains && use->meaning.role != SourceRole::module) return nullptr;
      at = end_of_call(tokens_, use->arguments);
    }
  }

  // A move that the next one replaces in the same tick, for it moves the same joints.
  void replaced(const SourceUse& use) {
    if (use.at > 0 && tokens_[use.at - 1].is_any({"return", "(", ",", "{", "and", "or", "not"})) return;
    const SourceUse* const next = next_statement(end_of_call(tokens_, use.arguments));
    if (next == nullptr || !is_move(*next) || next->meaning.path != use.meaning.path) return;
    const std::vector<std::size_t> first = parts_of(tokens_, use.arguments),
                                   second = parts_of(tokens_, next->arguments);
    if (first.size() != 2 || second.size() != 2 || !(time_of(first[1]) > 0)) return;
    const auto moved = joints_of(first[0], false), again = joints_of(second[0], false);
    if (!moved || !again || moved->empty()) return;
    if (!std::includes(again->begin(), again->end(), moved->begin(), moved->end())) return;
    tell(use.line, "this move is replaced at once by the one in line " + std::to_string(next->line) +
                       ": wait for it in run, move(...):wait()");
  }

  // A move to one pose that begins anew in each tick.
  void begun_anew(const SourceUse& use) {
    constexpr double tick_s = 0.02;  // two ticks: it arrives
    const bool straight = !blocks_.empty() && tokens_[blocks_.back().token].is("function") && !blocks_.back().returns;
    const bool chosen = use.at > 0 && tokens_[use.at - 1].is_any({"and", "or"});
    const bool waits = tokens_[end_of_call(tokens_, use.arguments)].is(":");  // which is told by itself
    if (use.at_once != "during" || !straight || chosen || waits) return;
    const std::vector<std::size_t> given = parts_of(tokens_, use.arguments);
    if (given.size() != 2 || !(time_of(given[1]) > tick_s) || !joints_of(given[0], true)) return;
    tell(use.line,
         "during begins this move anew in each tick, so that it never arrives: move in enter, or use follow(...)");
  }

  // key = in the braces of a table
  void key(std::size_t at) {
    if (blocks_.empty() || !tokens_[blocks_.back().token].is("{")) return;
    if (at == 0 || !tokens_[at - 1].is_any({"{", ",", ";"})) return;
    const bool bracket = tokens_[at].is("[") && tokens_[at + 1].kind == TokenKind::text && tokens_[at + 2].is("]");
    const SourceToken& name = bracket ? tokens_[at + 1] : tokens_[at];
    if (!tokens_[bracket ? at + 3 : at + 1].is("=") || (!bracket && name.kind != TokenKind::name)) return;
    const auto [first, added] = blocks_.back().keys.emplace(name.text, name.line);
    if (!added)
      tell(name.line, "'" + name.text + "' stands twice in this table: the one in line " +
                          std::to_string(first->second) + " is lost");
  }

  // A plain value in a local of the file, which a function of the chart changes.
  void local_of_file(const SourceUse& use) {
    if (!of_behavior_ || !use.assigned || !use.outer || use.written != 0 || use.guard || use.states.empty()) return;
    if (!tokens_[use.next].is("=") || locals_of_file_.erase(use.declared) == 0) return;
    const SourceToken& value = tokens_[use.next + 1];
    const bool flag = tokens_[use.declared + 2].is_any({"true", "false"});
    if (value.is_any({"function", "{"}) || (flag && !value.is_any({"true", "false", "not"}))) return;
    tell(use.line, "'" + use.name + "' is a local of the file, which a reload forgets: keep it in vars = { " +
                       use.name + " = " + tokens_[use.declared + 2].text + " } as m.vars." + use.name);
  }

  void enter_token(std::size_t at) {
    const SourceToken& token = tokens_[at];
    key(at);
    const bool plain = token.is("local") && blocks_.empty() && tokens_[at + 2].is("=") && tokens_[at + 3].is_literal();
    if (plain && tokens_[at + 4].line > tokens_[at + 3].line) locals_of_file_.insert(at + 1);
    if (token.is("while") || token.is("repeat")) loop(at);
    if (token.is("return")) {
      for (Block& block : blocks_) block.returns = true;
    }
    const int change = opens(token);
    if (change > 0) blocks_.push_back({at, false, {}});
    if (change < 0 && !blocks_.empty()) blocks_.pop_back();
  }

  const Catalog& catalog_;
  const KnownNames& known_;
  bool of_behavior_;
  const Tokens& tokens_;
  std::map<std::size_t, SourceUse> uses_;
  std::set<std::size_t> assigned_;  // the names that get a value anywhere but where they are declared
  std::vector<Block> blocks_;
  std::set<std::size_t> locals_of_file_;  // the tokens that declare them with a plain value
  Mistakes found_;
};

}  // namespace

Mistakes flow_mistakes(const Catalog& catalog, const KnownNames& known, bool of_behavior,
                       const std::vector<SourceUse>& uses, const Tokens& tokens) {
  return FlowCheck(catalog, known, of_behavior, uses, tokens).run();
}

}  // namespace kadans
