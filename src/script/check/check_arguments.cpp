// Literal arguments of calls in the text: names of poses, set-points, presets, parameters and joints, and the ranges of
// numbers.
#include <algorithm>
#include <cstdlib>
#include <string_view>

#include "check_source.h"
#include "hint.h"
#include "script/bindings/bindings.h"
#include "script/motion/motion_options.h"
#include "script/motion/task_targets.h"
#include "signal/number_text.h"

namespace kadans {
namespace {

// A number with nothing behind it that would change it: `1.5` or `-1.5` before a comma or a bracket.
bool number_at(const Tokens& tokens, std::size_t at, double& value) {
  const bool negative = tokens[at].is("-");
  if (negative) ++at;
  if (tokens[at].kind != TokenKind::number) return false;
  const SourceToken& after = tokens[at + 1];
  if (!after.is(",") && !after.is(")") && !after.is("}") && !after.is(";")) return false;
  value = std::strtod(tokens[at].text.c_str(), nullptr);
  if (negative) value = -value;
  return true;
}

std::string outside(const std::string& name, double value, double min, double max, const std::string& unit) {
  return printed("%s = %.14g is outside its range %.14g..%.14g %s", name.c_str(), value, min, max, unit.c_str()) +
         degree_hint(unit, value, min, max).data();
}

// A text that is the whole argument.
bool whole_text(const Tokens& tokens, std::size_t at) {
  const SourceToken& after = tokens[at + 1];
  return tokens[at].kind == TokenKind::text && !after.is("..") && !after.is(":");
}

// Where the names stand in { name = value, ... } at `at`.
std::vector<std::size_t> keys_of_table(const Tokens& tokens, std::size_t at) {
  std::vector<std::size_t> keys;
  if (!tokens[at].is("{")) return keys;
  for (const std::size_t part : parts_of(tokens, at + 1)) {
    if (tokens[part].kind == TokenKind::name && tokens[part + 1].is("=")) keys.push_back(part);
  }
  return keys;
}

bool has_key(const Tokens& tokens, std::size_t at, std::string_view name) {
  return std::ranges::any_of(keys_of_table(tokens, at), [&](std::size_t key) { return tokens[key].text == name; });
}

bool has_value(const Tokens& tokens, std::size_t at, std::string_view name, std::string_view text) {
  return std::ranges::any_of(keys_of_table(tokens, at), [&](std::size_t key) {
    return tokens[key].text == name && tokens[key + 2].kind == TokenKind::text && tokens[key + 2].text == text;
  });
}

// A text, a number or a flag that is the whole argument.
bool whole_literal(const Tokens& tokens, std::size_t at) {
  double ignored = 0;
  return whole_text(tokens, at) || number_at(tokens, at, ignored) || tokens[at].is("true") || tokens[at].is("false");
}

void append(Mistakes& problems, const Mistakes& more) { problems.insert(problems.end(), more.begin(), more.end()); }

// The type of a literal, as Lua names it.
std::string literal_type(const Tokens& tokens, std::size_t at) {
  if (tokens[at].kind == TokenKind::text) return "string";
  return tokens[at].is_any({"true", "false"}) ? "boolean" : "number";
}

// What a literal option must be when it is something else; nullptr: it is that.
const char* other_type(const Tokens& tokens, std::size_t at, const MotionOption& option) {
  constexpr std::pair<const char*, const char*> types[] = {// as MotionOption::Type
                                                           {"number", " must be a number, without quotes"},
                                                           {"string", " must be a text"},
                                                           {"boolean", " must be true or false"},
                                                           {"table", " must be a list { ... }"}};
  static_assert(std::size(types) == static_cast<std::size_t>(MotionOption::Type::list) + 1);
  const auto& [type, wanted] = types[static_cast<std::size_t>(option.type)];
  return literal_type(tokens, at) == type ? nullptr : wanted;
}

// One `name = value` of a motion's options, as the bindings will see it.
Mistakes motion_option(const Tokens& tokens, std::size_t key, MotionOption::Method method, const std::string& called) {
  std::vector<std::string> names;
  for (const MotionOption& option : motion_options()) {
    if ((option.methods & method) == 0) continue;
    names.emplace_back(option.name);
    if (tokens[key].text != option.name) continue;
    double value = 0;
    const bool number = number_at(tokens, key + 2, value);
    if (option.type == MotionOption::Type::number && number && !(value >= option.min && value <= option.max))
      return {{tokens[key].line, outside(called + ": " + option.name, value, option.min, option.max, option.unit)}};
    const bool literal = number || whole_literal(tokens, key + 2);
    const char* const wanted = literal ? other_type(tokens, key + 2, option) : nullptr;
    if (wanted != nullptr) return {{tokens[key].line, called + ": " + option.name + wanted}};
    if (option.type != MotionOption::Type::text || !whole_text(tokens, key + 2)) return {};
    const std::string& given = tokens[key + 2].text;
    const std::vector<std::string> profiles(std::begin(motion_profiles), std::end(motion_profiles));
    if (std::find(profiles.begin(), profiles.end(), given) != profiles.end()) return {};
    return {{tokens[key].line, called + ": unknown profile '" + given + "'" + hint_text(given, profiles)}};
  }
  return {{tokens[key].line, called + " has no key '" + tokens[key].text + "'" + hint_text(tokens[key].text, names)}};
}

// The options written out at `at`.
Mistakes motion_table(const Tokens& tokens, std::size_t at, MotionOption::Method method, const std::string& called) {
  Mistakes problems;
  if (!tokens[at].is("{")) return problems;
  for (const std::size_t key : keys_of_table(tokens, at)) append(problems, motion_option(tokens, key, method, called));
  if (!problems.empty()) return problems;
  const auto has = [&](const char* name) { return has_key(tokens, at, name); };
  const auto tell = [&](const std::string& text) { problems.push_back({tokens[at].line, called + text}); };
  if (method == MotionOption::move && !has("time_s") && !has("profile")) tell(" needs { time_s = seconds } at the end");
  if (method == MotionOption::point && !has("time_s")) tell(" needs time_s > 0");
  const bool lengths = has("velocity_max_m_s") || has("acceleration_max_m_s2");  // which may not fit the set-point
  const bool velocity = has("velocity_max_rad_s"), acceleration = has("acceleration_max_rad_s2");
  const bool limits = lengths || velocity || acceleration;
  const bool trapezoid = has_value(tokens, at, "profile", "trapezoid") && !lengths;
  if (trapezoid && !(velocity && acceleration) && !has("time_s"))
    tell(": a trapezoid needs time_s, or velocity_max and acceleration_max");
  if (limits && !has("profile") && method != MotionOption::follow)
    tell(": velocity_max and acceleration_max need profile = \"trapezoid\"");
  if (has("profile") && has("time_s") && limits) tell(": a trapezoid takes time_s or limits, not both");
  return problems;
}

struct ArgumentCheck {
  struct Range {
    std::string name, unit;
    double min = 0, max = 0;
  };

  const Catalog& catalog;
  const Tokens& tokens;

  Mistakes pose_name(std::size_t at) const {
    if (catalog.model == nullptr || !whole_text(tokens, at)) return {};  // of no robot
    const std::vector<std::string> names = names_of(catalog.poses);
    if (std::ranges::find(names, tokens[at].text) != names.end()) return {};
    return {{tokens[at].line, "unknown pose '" + tokens[at].text + "'" + hint_text(tokens[at].text, names)}};
  }

  template <typename Named>
  static Range range_of(const ObjectInfo& object, const Named& one) {
    return {short_name(object, one.name), one.unit, one.min, one.max};
  }

  std::vector<Range> setpoints(const ObjectInfo& object) const {
    std::vector<Range> all;
    for (const SetpointId id : object.setpoints) all.push_back(range_of(object, catalog.setpoints[id]));
    return all;
  }

  std::vector<Range> parameters(const ObjectInfo& object) const {
    std::vector<Range> all;
    for (const ParameterId id : object.parameters) all.push_back(range_of(object, catalog.parameters.info(id)));
    return all;
  }

  // { task = value, ... } at `at` (task_targets.h): the words outside; what is in their tables shows in the run.
  Mistakes task_table(const ObjectInfo& object, const std::vector<Range>& ranges, std::size_t at) const {
    Mistakes problems;
    std::vector<std::string> words;
    for (const Range& range : ranges) words.emplace_back(task_word(range.name, true).outer().data());
    for (const std::size_t key : keys_of_table(tokens, at)) {
      const std::string& name = tokens[key].text;
      if (std::ranges::find(words, name) != words.end()) continue;
      problems.push_back(
          {tokens[key].line, "'" + object.name + "' has no task '" + name + "'" + hint_text(name, words)});
    }
    return problems;
  }

  // { joint = number, ... } at `at`.
  Mistakes pose_table(const ObjectInfo& object, std::size_t at, bool offsets) const {
    Mistakes problems;
    const std::vector<Range> ranges = setpoints(object);
    std::vector<std::string> joints;
    for (const std::size_t joint : object.joints) joints.push_back(catalog.model->joints[joint].name);
    if (has_tasks(catalog, object)) return task_table(object, ranges, at);
    for (const std::size_t key : keys_of_table(tokens, at)) {
      const std::string& name = tokens[key].text;
      const auto range = std::ranges::find(ranges, name + ".position_rad", &Range::name);
      double value = 0;
      if (range == ranges.end()) {
        problems.push_back(
            {tokens[key].line, "'" + object.name + "' moves no joint '" + name + "'" + hint_text(name, joints)});
      } else if (!offsets && number_at(tokens, key + 2, value) && !(value >= range->min && value <= range->max)) {
        problems.push_back(
            {tokens[key].line, outside(object.name + "." + range->name, value, range->min, range->max, "rad")});
      }
    }
    return problems;
  }

  Mistakes named_value(const ObjectInfo& object, const std::vector<Range>& ranges, const std::string& kind,
                       std::size_t at, bool offset = false) const {
    if (!whole_text(tokens, at)) return {};
    const std::string& name = tokens[at].text;
    std::vector<std::string> names;
    for (const Range& range : ranges) {
      names.push_back(range.name);
      if (range.name != name) continue;
      double value = 0;
      if (offset || !tokens[at + 1].is(",") || !number_at(tokens, at + 2, value)) return {};
      if (value >= range.min && value <= range.max) return {};
      return {{tokens[at].line, outside(object.name + "." + name, value, range.min, range.max, range.unit)}};
    }
    return {{tokens[at].line, "'" + object.name + "' has no " + kind + " '" + name + "'" + hint_text(name, names)}};
  }

  Mistakes preset(const ObjectInfo& object, std::size_t at) const {
    if (tokens[at].is("{") || (!whole_text(tokens, at) && whole_literal(tokens, at)))
      return {{tokens[at].line, "set_gains takes the name of gains; one number goes by set_parameter(name, value)"}};
    if (!whole_text(tokens, at)) return {};
    const std::vector<std::string> names = names_of(object.presets);
    if (std::ranges::find(names, tokens[at].text) != names.end()) return {};
    return {{tokens[at].line,
             "'" + object.name + "' has no gains '" + tokens[at].text + "'" + hint_text(tokens[at].text, names)}};
  }

  Mistakes pose(const ObjectInfo& object, std::size_t at, bool offsets) const {
    return tokens[at].is("{") ? pose_table(object, at, offsets) : pose_name(at);
  }

  // { { pose, time_s = }, ... } at `at`.
  Mistakes points(const ObjectInfo& object, std::size_t at, bool offsets) const {
    Mistakes problems;
    if (!tokens[at].is("{")) return problems;
    for (const std::size_t point : parts_of(tokens, at + 1)) {
      if (!tokens[point].is("{")) continue;
      append(problems, pose(object, point + 1, offsets));
      append(problems, motion_table(tokens, point, MotionOption::point, "a point of move_through"));
    }
    return problems;
  }

  Mistakes of_motion(const ObjectInfo& object, const MotionMethod& method, std::size_t at) const {
    const std::vector<std::size_t> given =
        tokens[at - 1].is("(") ? parts_of(tokens, at) : std::vector<std::size_t>{at};  // or a text, or a table
    if (given.empty()) return {};
    const std::size_t options = method.kind == MotionOption::set ? 2 : 1;
    const bool there = given.size() > options;
    const bool offsets = there && has_key(tokens, given[options], "relative");
    Mistakes problems;
    if (method.kind == MotionOption::set) {
      problems = named_value(object, setpoints(object), "set-point", at, offsets);
    } else if (method.kind == MotionOption::through) {
      problems = points(object, at, offsets);
    } else {
      problems = pose(object, at, offsets);
    }
    if (there && whole_literal(tokens, given[options]))
      problems.push_back({tokens[given[options]].line, std::string(method.name) +
                                                           ": the last argument must be a table { ... }, not a " +
                                                           literal_type(tokens, given[options]) + ": { time_s = 1 }"});
    if (there) append(problems, motion_table(tokens, given[options], method.kind, method.name));
    if (!there && method.needs != nullptr)
      problems.push_back({tokens[at].line, std::string(method.name) + method.needs});
    return problems;
  }

  Mistakes of_method(const ObjectInfo& object, const std::string& method, std::size_t at) const {
    if (method == "set_gains") return preset(object, at);
    if (method == "setpoint") return named_value(object, setpoints(object), "set-point", at);
    if (method == "set_parameter" || method == "parameter")
      return named_value(object, parameters(object), "parameter", at);
    for (const MotionMethod& known : motion_methods()) {
      if (method == known.name) return of_motion(object, known, at);
    }
    return {};
  }
};

}  // namespace

Mistakes pose_mistakes(const Catalog& catalog, const Tokens& tokens, std::size_t at) {
  return ArgumentCheck{catalog, tokens}.pose_name(at);
}

Mistakes argument_mistakes(const Catalog& catalog, const ObjectInfo& object, const std::string& method,
                           const Tokens& tokens, std::size_t at) {
  return ArgumentCheck{catalog, tokens}.of_method(object, method, at);
}

}  // namespace kadans
