#include "check_arguments.h"

#include <algorithm>
#include <cstdio>
#include <cstdlib>

#include "hint.h"

namespace kadans {
namespace {

using Kind = SourceToken::Kind;
using Problems = std::vector<ArgumentProblem>;

// A number with nothing behind it that would change it: `1.5` or `-1.5` before a comma or a bracket.
bool number_at(const std::vector<SourceToken>& tokens, std::size_t at, double& value) {
  const bool negative = tokens[at].is("-");
  if (negative) ++at;
  if (tokens[at].kind != Kind::number) return false;
  const SourceToken& after = tokens[at + 1];
  if (!after.is(",") && !after.is(")") && !after.is("}") && !after.is(";")) return false;
  value = std::strtod(tokens[at].text.c_str(), nullptr);
  if (negative) value = -value;
  return true;
}

std::string outside(const std::string& name, double value, double min, double max, const std::string& unit) {
  char text[256];
  std::snprintf(text, sizeof text, "%s = %.14g is outside its range %.14g..%.14g %s", name.c_str(), value, min, max,
                unit.c_str());
  return text;
}

// A text that is the whole argument.
bool whole_text(const std::vector<SourceToken>& tokens, std::size_t at) {
  const SourceToken& after = tokens[at + 1];
  return tokens[at].kind == Kind::text && !after.is("..") && !after.is(":");
}

std::string short_name(const ObjectInfo& object, const std::string& name) {
  return name.substr(std::min(name.size(), object.name.size() + 1));
}

}  // namespace

const ObjectInfo* ArgumentCheck::object(const std::string& name) const noexcept {
  const auto found = std::find_if(catalog_.objects.begin(), catalog_.objects.end(),
                                  [&](const ObjectInfo& object) { return object.name == name; });
  return found == catalog_.objects.end() ? nullptr : &*found;
}

Problems ArgumentCheck::pose_name(const Tokens& tokens, std::size_t at) const {
  if (!whole_text(tokens, at)) return {};
  std::vector<std::string> names;
  for (const PoseInfo& pose : catalog_.poses) {
    if (pose.name == tokens[at].text) return {};
    names.push_back(pose.name);
  }
  return {{tokens[at].line, "unknown pose '" + tokens[at].text + "'" + hint_text(tokens[at].text, names)}};
}

std::vector<ArgumentCheck::Range> ArgumentCheck::setpoints(const ObjectInfo& object) const {
  std::vector<Range> all;
  for (const SetpointId id : object.setpoints) {
    const Setpoint& setpoint = catalog_.setpoints[id];
    all.push_back({short_name(object, setpoint.name), setpoint.unit, setpoint.min, setpoint.max});
  }
  return all;
}

std::vector<ArgumentCheck::Range> ArgumentCheck::parameters(const ObjectInfo& object) const {
  std::vector<Range> all;
  for (const ParameterId id : object.parameters) {
    const Parameter& parameter = catalog_.parameters.info(id);
    all.push_back({short_name(object, parameter.name), parameter.unit, parameter.min, parameter.max});
  }
  return all;
}

// { joint = number, ... } at `at`.
Problems ArgumentCheck::pose_table(const ObjectInfo& object, const Tokens& tokens, std::size_t at) const {
  Problems problems;
  const std::vector<Range> ranges = setpoints(object);
  std::vector<std::string> joints;
  for (const std::size_t joint : object.joints) joints.push_back(catalog_.model->joints[joint].name);
  int depth = 0;
  for (; tokens[at].kind != Kind::end; ++at) {
    for (const char* opens : {"(", "{", "[", "function", "if", "do"}) depth += tokens[at].is(opens) ? 1 : 0;
    for (const char* closes : {")", "}", "]", "end"}) depth -= tokens[at].is(closes) ? 1 : 0;
    if (depth == 0) break;
    const bool key = depth == 1 && tokens[at].kind == Kind::name && tokens[at + 1].is("=") &&
                     (tokens[at - 1].is("{") || tokens[at - 1].is(",") || tokens[at - 1].is(";"));
    if (!key) continue;
    const std::string& name = tokens[at].text;
    const auto range = std::find_if(ranges.begin(), ranges.end(),
                                    [&](const Range& known) { return known.name == name + ".position_rad"; });
    double value = 0;
    if (range == ranges.end()) {
      problems.push_back(
          {tokens[at].line, "'" + object.name + "' moves no joint '" + name + "'" + hint_text(name, joints)});
    } else if (number_at(tokens, at + 2, value) && !(value >= range->min && value <= range->max)) {
      problems.push_back(
          {tokens[at].line, outside(object.name + "." + range->name, value, range->min, range->max, "rad")});
    }
  }
  return problems;
}

Problems ArgumentCheck::named_value(const ObjectInfo& object, const std::vector<Range>& ranges, const std::string& kind,
                                    const Tokens& tokens, std::size_t at) const {
  if (!whole_text(tokens, at)) return {};
  const std::string& name = tokens[at].text;
  std::vector<std::string> names;
  for (const Range& range : ranges) {
    names.push_back(range.name);
    if (range.name != name) continue;
    double value = 0;
    if (!tokens[at + 1].is(",") || !number_at(tokens, at + 2, value)) return {};
    if (value >= range.min && value <= range.max) return {};
    return {{tokens[at].line, outside(object.name + "." + name, value, range.min, range.max, range.unit)}};
  }
  return {{tokens[at].line, "'" + object.name + "' has no " + kind + " '" + name + "'" + hint_text(name, names)}};
}

Problems ArgumentCheck::preset(const ObjectInfo& object, const Tokens& tokens, std::size_t at) const {
  if (!whole_text(tokens, at)) return {};
  std::vector<std::string> names;
  for (const Preset& known : object.presets) {
    if (known.name == tokens[at].text) return {};
    names.push_back(known.name);
  }
  return {{tokens[at].line,
           "'" + object.name + "' has no gains '" + tokens[at].text + "'" + hint_text(tokens[at].text, names)}};
}

Problems ArgumentCheck::of_method(const ObjectInfo& object, const std::string& method, const Tokens& tokens,
                                  std::size_t at) const {
  if (method == "set_gains") return preset(object, tokens, at);
  if (method == "set") return named_value(object, setpoints(object), "set-point", tokens, at);
  if (method == "set_parameter") return named_value(object, parameters(object), "parameter", tokens, at);
  if (method != "move") return {};
  Problems problems = tokens[at].is("{") ? pose_table(object, tokens, at) : pose_name(tokens, at);
  int depth = 0;
  bool timed = false;
  for (std::size_t i = at; tokens[i].kind != Kind::end && depth >= 0; ++i) {
    for (const char* opens : {"(", "{", "[", "function", "if", "do"}) depth += tokens[i].is(opens) ? 1 : 0;
    for (const char* closes : {")", "}", "]", "end"}) depth -= tokens[i].is(closes) ? 1 : 0;
    timed = timed || tokens[i].is(",");
    if (depth == 1 && tokens[i].text == "time" && tokens[i + 1].is("=")) {
      problems.push_back({tokens[i].line, "move has no key 'time', did you mean 'time_s'?"});
    }
  }
  if (!timed) problems.push_back({tokens[at].line, "move needs { time_s = seconds } at the end"});
  return problems;
}

}  // namespace kadans
