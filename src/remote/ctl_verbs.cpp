#include "ctl_verbs.h"

#include <algorithm>
#include <iterator>

#include "kadans/config/foreign_json.h"
#include "kadans/config/problems.h"

namespace kadans {
namespace {

using enum CtlField::Kind;
using Is = Order::Kind;

const CtlVerb verbs[] = {
    {"status", Role::read, Is::report},
    {"list", Role::read, Is::report, {{{"what", text, true}}}},
    {"get", Role::read, Is::report, {{{"name", text, true}}}},
    {"faults", Role::read, {}},
    {"watch", Role::read, {}, {{{"signals", texts, true}, {"rate_hz", number}}}},
    {"unwatch", Role::read, {}},
    {"play", Role::operate, Is::play, {{{"list", text, true}, {"replace", flag}}}},
    {"pause", Role::operate, Is::pause},
    {"resume", Role::operate, Is::resume},
    {"stop", Role::operate, Is::stop},
    {"switch", Role::operate, Is::switch_set, {{{"set", text, true}}}},
    {"clear_faults", Role::operate, Is::clear_faults},
    {"estop", Role::operate, {}},
    {"record_start", Role::operate, Is::record_start, {{{"file", text}}}},
    {"record_stop", Role::operate, Is::record_stop},
    {"record_dump", Role::operate, Is::record_dump, {{{"file", text}}}},
    {"set", Role::develop, Is::set_parameter, {{{"name", text, true}, {"value", number, true}}}},
    {"undo", Role::develop, Is::undo},
    {"save", Role::develop, Is::changes, {{{"preset", text}}}},
    {"reload", Role::develop, Is::reload, {{{"name", text}}}},
    {"line", Role::develop, Is::line, {{{"text", text, true}}}},
    {"complete", Role::develop, Is::complete, {{{"text", text, true}}}},
};

[[noreturn]] void fail(const std::string& why) { throw InputError({.message = why}); }

bool fits(const Json& value, CtlField::Kind kind) {
  switch (kind) {
    case text:
      return value.is_string();
    case number:
      return value.is_number();
    case flag:
      return value.is_boolean();
    case texts:
      return value.is_array() && std::ranges::all_of(value, [](const Json& one) { return one.is_string(); });
    case none:
      break;
  }
  return false;
}

const char* kind_text(CtlField::Kind kind) {
  switch (kind) {
    case number:
      return "a number";
    case flag:
      return "true or false";
    case texts:
      return "an array of strings";
    default:
      return "a string";
  }
}

const CtlVerb& verb_named(const std::string& name) {
  const auto found = std::ranges::find(verbs, name, [](const CtlVerb& verb) { return std::string_view(verb.name); });
  if (found != std::end(verbs)) return *found;
  std::vector<std::string> names;
  for (const CtlVerb& verb : verbs) names.emplace_back(verb.name);
  fail(unknown_name("verb", name, names));
}

void check_fields(const CtlVerb& verb, const Json& json) {
  std::vector<std::string> known{"verb"};
  for (const CtlField& field : verb.fields) {
    if (field.kind == none) continue;
    known.emplace_back(field.name);
    const auto given = json.find(field.name);
    if (given == json.end() && field.required) fail(std::string(verb.name) + " needs \"" + field.name + "\"");
    if (given != json.end() && !fits(*given, field.kind))
      fail(std::string("\"") + field.name + "\" must be " + kind_text(field.kind));
  }
  for (const auto& [key, value] : json.items()) {
    if (std::ranges::find(known, key) == known.end())
      fail(unknown_name("field", key, known, std::string("of ") + verb.name));
  }
}

}  // namespace

CtlRequest read_request(const std::string& line, Role role) {
  CtlRequest request;
  std::optional<Json> json = read_foreign_json(line);
  if (!json || !json->is_object()) fail("this is no JSON object on one line");
  request.json = std::move(*json);
  const auto verb = request.json.find("verb");
  if (verb == request.json.end() || !verb->is_string()) fail("a request needs \"verb\", a string");
  request.verb = &verb_named(verb->get<std::string>());
  check_fields(*request.verb, request.json);
  if (request.verb->role > role)
    fail(std::string("'") + request.verb->name + "' needs the role " + name(request.verb->role) +
         "; this socket gives " + name(role));
  return request;
}

}  // namespace kadans
