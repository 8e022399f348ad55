// Values in the text: comparisons, joined texts, formats and arguments that cannot be right because of what the names
// stand for, in whatever branch they are.
#include <algorithm>
#include <cstdlib>
#include <iterator>
#include <string_view>

#include "check_source.h"
#include "hint.h"
#include "script/bindings/api.h"
#include "script/bindings/bindings.h"
#include "script/motion/motion_options.h"
#include "signal/number_text.h"
#include "signal/status_fields.h"

namespace kadans {
namespace {

bool compares(const SourceToken& token) { return token.is_any({"==", "~=", "<", ">", "<=", ">="}); }
bool calculates(const SourceToken& token) { return token.is_any({"+", "-", "*", "/", "%", "^"}); }
// Whether the token makes another value of what stands beside it.
bool changes(const SourceToken& token) { return calculates(token) || token.is_any({"..", "#", "not"}); }
bool goes_on(const SourceToken& token) { return changes(token) || token.is_any({".", ":", "[", "("}); }

const SourceToken& before(const Tokens& tokens, std::size_t at, std::size_t steps = 1) {
  static const SourceToken no_token;
  return at >= steps ? tokens[at - steps] : no_token;
}

bool is_truth(const SourceToken& token) { return token.is("true") || token.is("false"); }

// Lua takes "1" for 1 where it calculates.
bool is_numeral(const std::string& text) {
  char* end = nullptr;
  const double value = std::strtod(text.c_str(), &end);
  (void)value;
  return end != text.c_str() && std::string_view(end).find_first_not_of(' ') == std::string_view::npos;
}

std::string as_written(const Tokens& tokens, std::size_t from, std::size_t to) {
  std::string text;
  for (std::size_t i = from; i < to; ++i) text += tokens[i].text;
  return text;
}

// The texts of a field whose type is written as 'moving'|'done'.
std::vector<std::string> texts_in_api(std::string_view owner, std::string_view name) {
  std::vector<std::string> texts;
  for (const ApiEntry& entry : script_api()) {
    if (owner != entry.owner || name != entry.name) continue;
    std::string_view type = entry.type;
    while (type.starts_with('\'')) {
      const std::size_t end = type.find('\'', 1);
      texts.emplace_back(type.substr(1, end - 1));
      type.remove_prefix(std::min(end + 2, type.size()));
    }
  }
  return texts;
}

// The function of a motion or of m whose first argument is what stands before the colon.
bool without_colon(const SourceUse& use, const Tokens& tokens) {
  return use.arguments != 0 && use.method.empty() &&
         !(tokens[use.arguments - 1].is("(") && tokens[use.arguments].kind == TokenKind::name);
}

class ValueCheck {
 public:
  ValueCheck(const Behavior::Parts& parts, const Tokens& tokens)
      : parts_(parts), tokens_(tokens), fields_(status_fields(parts.catalog.sensors, parts.catalog.seen)) {}

  // What is wrong with what stands around one use of a name.
  Mistakes of_use(const SourceUse& use) const {
    Mistakes found;
    if (use.assigned) return found;
    const std::string wrong = call(use);
    if (!wrong.empty()) found.push_back({use.line, wrong});
    const std::string unit = other_unit(use);
    if (!unit.empty()) found.push_back({use.line, unit});
    SourceMeaning meaning = use.known ? use.meaning : SourceMeaning{};
    const bool in_brackets = !meaning.path.empty() && meaning.path.back() == "*";  // s.joints[1]
    if (in_brackets) meaning.path.pop_back();
    const Type type = type_of(meaning);
    if (in_brackets && type.kind != Kind::by_name) return found;
    if (type.kind == Kind::unknown || !use.method.empty()) return found;
    if (use.arguments == 0) {
      operands(use, type, found);
    } else if (tokens_[use.arguments - 1].is("(") && type.kind != Kind::by_name) {
      found.push_back(
          {use.line, as_written(tokens_, use.at, use.next - 1) + " is a value: it stands without brackets"});
    }
    return found;
  }

  // What is wrong with values that are written out: "a" + 1, x .. nil.
  Mistakes of_literals() const {
    Mistakes found;
    for (std::size_t i = 1; i + 1 < tokens_.size(); ++i) {
      const SourceToken& token = tokens_[i];
      const SourceToken& left = tokens_[i - 1];
      const SourceToken& right = tokens_[i + 1];
      const bool nothing = token.is("nil") || is_truth(token);
      if (nothing && (left.is("..") || right.is("..")))
        found.push_back({token.line, ".. joins texts and numbers, not " + token.text});
      if (token.kind != TokenKind::text || is_numeral(token.text)) continue;
      const bool of_call = left.kind == TokenKind::name || left.kind == TokenKind::text || left.is_any({")", "]", "}"});
      if (of_call) continue;  // f "text" + 1
      if (right.is("%")) {
        found.push_back({token.line, "% does not fill a text: write string.format(text, ...)"});
      } else if (right.is("+") || left.is("+")) {
        found.push_back({token.line, "+ adds numbers, .. joins texts"});
      } else if (calculates(right) || calculates(left)) {
        found.push_back({token.line, "\"" + token.text + "\" is a text, no number"});
      }
    }
    return found;
  }

 private:
  // What a name stands for; `texts` are all that a choice may be.
  enum class Kind : std::uint8_t { unknown, number, flag, choice, by_name };
  struct Type {
    Kind kind = Kind::unknown;
    std::vector<std::string> texts;
    bool measured = false;  // a number that comes from a sensor
  };

  Type field_of(StatusField::Part part, const std::string& name, std::size_t index = 0) const {
    for (const StatusField& field : fields_) {
      if (!field.is_of(part, index) || field.name != name) continue;
      if (field.type == StatusField::Type::number) {
        using Part = StatusField::Part;
        const bool sensed = part == Part::joint || part == Part::base || part == Part::rate || part == Part::foot ||
                            part == Part::support || part == Part::odometry;
        return {Kind::number, {}, sensed};
      }
      if (field.type == StatusField::Type::flag) return {Kind::flag, {}};
      Type type{Kind::choice, {}};
      for (std::size_t i = 0; i < field.choices; ++i) type.texts.emplace_back(field.choice(i));
      return type;
    }
    return {};
  }

  Type type_of(const SourceMeaning& meaning) const {
    using Part = StatusField::Part;
    const auto& path = meaning.path;
    if (meaning.role == SourceRole::motion && path.size() == 1) {
      if (path[0] == "done") return {Kind::flag, {}};
      if (path[0] == "outcome") return {Kind::choice, texts_in_api("motion", "outcome")};
    }
    if (meaning.role == SourceRole::machine && path == std::vector<std::string>{"time_s"}) return {Kind::number, {}};
    if (meaning.role != SourceRole::snapshot || path.empty()) return {};
    if (path.size() == 1 && (path[0] == "joints" || path[0] == "feet")) return {Kind::by_name, {}};
    if (path.size() == 1) return field_of(Part::root, path[0]);
    if (path.size() == 3 && path[0] == "joints") return field_of(Part::joint, path[2]);
    if (path.size() == 3 && path[0] == "feet") return field_of(Part::foot, path[2]);
    if (path.size() == 3 && path[0] == "base") return field_of(Part::rate, path[2]);
    if (path.size() == 3 && path[0] == "seen") {
      const auto& entries = parts_.catalog.seen;
      const auto entry = std::ranges::find(entries, path[1], &SeenInfo::name);
      if (entry != entries.end())
        return field_of(Part::seen, path[2], static_cast<std::size_t>(entry - entries.begin()));
      return field_of(Part::ball, path[2]);
    }
    constexpr std::pair<const char*, Part> parts[] = {{"base", Part::base},         {"support", Part::support},
                                                      {"odometry", Part::odometry}, {"safety", Part::safety},
                                                      {"joystick", Part::joystick}, {"sensors", Part::sensors}};
    for (const auto& [name, part] : parts) {
      if (path.size() == 2 && path[0] == name) return field_of(part, path[1]);
    }
    return {};
  }

  // Compared with the literal at `value`; "" when that may be right.
  std::string compared(const SourceUse& use, const Type& type, std::size_t value, const SourceToken& sign) const {
    const SourceToken& other = tokens_[value];
    const std::string name = as_written(tokens_, use.at, use.next);
    const bool text = other.kind == TokenKind::text, number = other.kind == TokenKind::number;
    const std::string what = text ? "a text" : number ? "a number" : "true or false";
    if (type.kind == Kind::number && !number) return name + " is a number, it is compared with " + what;
    const bool exactly = sign.is("==") || sign.is("~=");
    const bool no_force = name.ends_with("force_N") && other.text == "0";  // what does not touch reads exactly that
    if (type.measured && exactly && !no_force)
      return name + " is measured, it is hardly ever exactly " + other.text + ": compare with < or >";
    if (type.kind == Kind::flag && !is_truth(other))
      return name + " is true or false, it is compared with " + what + ": write " + name + " or not " + name;
    if (type.kind != Kind::choice) return "";
    const std::string choices = name + " is " + listed(type.texts, {}, ", ", " or ");
    if (!text) return choices + ", it is compared with " + what;
    if (!sign.is("==") && !sign.is("~=")) return choices + ": texts are compared with == or ~=";
    if (std::ranges::find(type.texts, other.text) != type.texts.end()) return "";
    return name + " is never \"" + other.text + "\"" + did_you_mean(other.text, type.texts) + "; it is " +
           listed(type.texts, {}, ", ", " or ");
  }

  void operands(const SourceUse& use, const Type& type, Mistakes& found) const {
    const SourceToken& left = before(tokens_, use.at);
    const SourceToken& right = tokens_[use.next];
    const std::string name = as_written(tokens_, use.at, use.next);
    const auto tell = [&](const std::string& text) {
      if (!text.empty()) found.push_back({use.line, text});
    };
    if (type.kind == Kind::by_name) {
      const bool counted = before(tokens_, use.at, 2).text == "ipairs" && left.is("(");
      if (left.is("#") || counted || (right.is("[") && tokens_[use.next + 1].kind == TokenKind::number))
        tell(name + " goes by names, not by numbers: for name, one in pairs(" + name + ") do");
      return;
    }
    if (compares(right) && tokens_[use.next + 1].is_literal() && !goes_on(tokens_[use.next + 2])) {
      if (left.is("not") && type.kind != Kind::flag) {
        tell("not binds closer than " + right.text + ": write " + name + (right.is("==") ? " ~= ..." : " == ..."));
      } else if (!changes(left)) {
        tell(compared(use, type, use.next + 1, right));
      }
    }
    if (compares(left) && before(tokens_, use.at, 2).is_literal() && !changes(before(tokens_, use.at, 3)) &&
        !changes(right))
      tell(compared(use, type, use.at - 2, left));
    if (type.kind == Kind::number) return;
    const bool flag = type.kind == Kind::flag;
    if (calculates(left) || calculates(right))
      tell(name + (flag ? " is true or false, no number" : " is a text, no number"));
    if (flag && (left.is("..") || right.is("..")))
      tell(name + " is true or false, which .. does not join: write tostring(" + name + ")");
  }

  // A parameter in milliseconds, minutes or hours where seconds are asked for: m:wait(P.x), time_s = P.x, after = P.x.
  std::string other_unit(const SourceUse& use) const {
    if (use.meaning.role != SourceRole::parameters || use.meaning.path.size() != 1) return "";
    const auto& declared = parts_.lua->core().parameters;
    const auto named = [&](const ScriptParameter& one) { return one.name == use.meaning.path[0]; };
    const auto found = std::ranges::find_if(declared, named);
    if (found == declared.end() || std::ranges::count_if(declared, named) != 1) return "";
    if (found->unit != "ms" && found->unit != "min" && found->unit != "h") return "";
    const SourceToken& left = before(tokens_, use.at);
    const SourceToken& name = before(tokens_, use.at, 2);
    const bool given = left.is("=") && (name.text == "after" || name.text.ends_with("_s"));
    const bool waits = left.is("(") && name.text == "wait" && before(tokens_, use.at, 3).is(":");
    if ((!given && !waits) || changes(tokens_[use.next])) return "";
    return name.text + " takes seconds, and " + found->name + " is in " + found->unit;
  }

  // What is wrong with how something is called, or given to a call.
  std::string call(const SourceUse& use) const {
    using Path = std::vector<std::string>;
    const auto& path = use.meaning.path;
    const SourceRole role = use.meaning.role;
    if (!use.known) {
      if (use.name == "string" && path == Path{"format"})
        return format_mistake(tokens_, use.arguments, "string.format");
      return use.name == "print" && path.empty() ? print_mistake(tokens_, use.arguments) : "";
    }
    if (role == SourceRole::module && !path.empty() && path[0] == "log" && use.arguments != 0) {
      if (path.size() == 1 && use.method.empty()) return "k.log is a table: write k.log.info(...), .warning or .error";
      return path.size() == 2 ? format_mistake(tokens_, use.arguments, "k.log." + path[1]) : "";
    }
    if (role == SourceRole::motion) {
      const bool given = before(tokens_, use.at, 2).text == "wait" && before(tokens_, use.at, 3).is(":");
      if (path.empty() && use.method.empty() && given && before(tokens_, use.at).is("(") && tokens_[use.next].is(")"))
        return "m:wait takes seconds; a motion waits for itself: " + use.name + ":wait()";
      if (path.size() == 1 && (path[0] == "wait" || path[0] == "cancel") && without_colon(use, tokens_))
        return "call it with a colon: " + use.name + ":" + path[0] + "()";
    }
    return role == SourceRole::machine ? machine_call(use) : "";
  }

  std::string machine_call(const SourceUse& use) const {
    const auto& path = use.meaning.path;
    if (use.arguments == 0) return "";
    const bool bracket = tokens_[use.arguments - 1].is("(");
    if (path.size() == 1 && use.method.empty()) {
      for (const char* method : {"wait", "emit", "on", "clear_faults", "reset_odometry", "use"}) {
        if (path[0] == method && without_colon(use, tokens_))
          return "call it with a colon: " + use.name + ":" + path[0] + "(...)";
      }
      return "";
    }
    if (path.size() == 1) {  // of a control object
      const std::size_t after = end_of_call(tokens_, use.arguments);
      const std::string& next = tokens_[after + 1].text;
      if (tokens_[after].is(".") && (next == "wait" || next == "cancel") && tokens_[after + 2].is("("))
        return "call it with a colon: " + use.method + "(...):" + next + "()";
      const bool motion =
          std::ranges::any_of(motion_methods(), [&](const auto& one) { return use.method == one.name; });
      const bool given = before(tokens_, use.at).is("(") && before(tokens_, use.at, 2).text == "wait";
      return motion && given && tokens_[after].is(")")
                 ? "m:wait takes seconds; a motion waits for itself: move(...):wait()"
                 : "";
    }
    if (!path.empty()) return "";
    if (use.method == "on") return armed(use);
    if (use.method != "wait") return "";
    const SourceToken& first = tokens_[use.arguments];
    if (first.is(")") && bracket) return "m:wait needs seconds: m:wait(1)";
    if (first.is_literal() && first.kind != TokenKind::number && !goes_on(tokens_[use.arguments + 1]))
      return "m:wait takes seconds, a number without quotes: m:wait(1)";
    if (first.is("{") || first.is("function") || first.is("nil")) return "m:wait takes seconds: m:wait(1)";
    if (first.is("-") && tokens_[use.arguments + 1].kind == TokenKind::number && tokens_[use.arguments + 2].is(")"))
      return "m:wait takes seconds >= 0";
    return "";
  }

  // A condition of m:on that is written out. What is measured has a name in the table, if anything measured has.
  std::string condition(const std::string& text) const {
    const ConditionText read = read_condition_text(text);
    if (read.wrong != nullptr) return std::string("m:on: ") + read.wrong;
    const std::string given(read.signal);
    if (is_truth_of_simulation(given))
      return "m:on: '" + given + "' is the truth of a simulation, which no robot knows";
    constexpr std::pair<const char*, const char*> in_snapshot[] = {
        {"feet.", "foot."}, {"joints.", "joint."}, {"s.", ""}};
    for (const auto& [wrong, right] : in_snapshot) {
      if (given.starts_with(wrong))
        return "m:on: unknown signal '" + given + "', did you mean '" + right +
               given.substr(std::string(wrong).size()) + "'?";
    }
    const SignalTable& signals = parts_.catalog.signals;
    const SignalName known = condition_signal(parts_.bindings, given);
    const std::string topic = given.substr(0, given.find('.') + 1);
    constexpr std::string_view measured[] = {"joint.", "base.", "foot.", "support.", "odometry."};
    const bool named = std::ranges::find(measured, topic) != std::end(measured) && signals.find("base.pitch_rad");
    if (!named || signals.find_key(signal_key(known.data()))) return "";
    return std::string("m:on: unknown signal '") + known.data() + "'" +
           hint_text(known.data(), signals_near(parts_.bindings, known.data()));
  }

  // m:on(condition, function(c) ... end, { within_s = })
  std::string armed(const SourceUse& use) const {
    if (!tokens_[use.arguments - 1].is("("))
      return "m:on takes three things: m:on(condition, function(c) ... end, { within_s = 1 })";
    const std::vector<std::size_t> given = parts_of(tokens_, use.arguments);
    const std::size_t end = end_of_call(tokens_, use.arguments) - 1;
    if (!given.empty() && tokens_[given[0]].kind == TokenKind::text && tokens_[given[0] + 1].is_any({",", ")"})) {
      std::string wrong = condition(tokens_[given[0]].text);
      if (!wrong.empty()) return wrong;
    }
    const std::size_t done = given.size() > 1 ? given[1] : end;
    const std::size_t done_end = given.size() > 2 ? given[2] - 1 : end;
    bool acts = false;  // m.posture:hold() in place of the function
    for (std::size_t i = done; i < done_end && !tokens_[done].is("function"); ++i) acts = acts || tokens_[i].is(":");
    if (given.size() < 2 || acts || tokens_[done].is_literal() || tokens_[done].is("{"))
      return "m:on needs a function that says what to do: function(c) c.posture:hold() end";
    for (std::size_t i = done; tokens_[done].is("function") && i < done_end; ++i) {
      if (tokens_[i].is(":") && tokens_[i + 1].text == "wait")
        return "m:on: the function runs once, when it is armed, and only records what to send: it cannot wait";
    }
    if (given.size() == 2 && tokens_[done].is("function"))
      return "m:on needs { within_s = seconds } at the end: for how long it may wait";
    if (given.size() < 3 || !tokens_[given[2]].is("{")) return "";
    bool timed = false;
    for (const std::size_t key : parts_of(tokens_, given[2] + 1)) {
      const std::string& name = tokens_[key].text;
      if (tokens_[key].kind != TokenKind::name || !tokens_[key + 1].is("=")) return "";
      if (name != "within_s" && name != "every_time" && name != "event")
        return "m:on has no option '" + name + "'" + hint_text(name, {"within_s", "every_time", "event"});
      timed = timed || name == "within_s";
    }
    return timed ? "" : "m:on needs within_s = seconds: for how long it may wait";
  }

  const Behavior::Parts& parts_;
  const Tokens& tokens_;
  std::vector<StatusField> fields_;
};

}  // namespace

Mistakes value_mistakes(const Behavior::Parts& parts, const std::vector<SourceUse>& uses, const Tokens& tokens) {
  const ValueCheck check(parts, tokens);
  Mistakes found = check.of_literals();
  for (const SourceUse& use : uses) std::ranges::move(check.of_use(use), std::back_inserter(found));
  return found;
}

}  // namespace kadans
