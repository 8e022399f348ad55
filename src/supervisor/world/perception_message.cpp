#include "perception_message.h"

#include <algorithm>
#include <cmath>

#include "config/json/json_value.h"
#include "kadans/signal/input_error.h"
#include "kadans/signal/nearest_name.h"

namespace kadans {
namespace {

using Kind = JsonValue::Kind;

[[noreturn]] void wrong(const JsonValue& at, const std::string& what) { refuse("", at.place, what); }

double number_in(const JsonValue& object, const std::string& name, double least, double most) {
  const JsonMember* found = object.find(name);
  if (found == nullptr) wrong(object, "'" + name + "' is missing");
  const double value = found->value.number;
  if (found->value.kind != Kind::number || !(value >= least && value <= most))
    wrong(found->value, "'" + name + "' is no number from " + std::to_string(least) + " to " + std::to_string(most));
  return value;
}

Observation one_seen(const JsonValue& object, const std::vector<SeenInfo>& declared, std::int64_t now_ns) {
  if (object.kind != Kind::object) wrong(object, "each thing that is seen is an object");
  const JsonMember* entry = object.find("entry");
  if (entry == nullptr || entry->value.kind != Kind::string) wrong(object, "'entry' is the name of an entry");
  const auto info = std::ranges::find(declared, entry->value.text, &SeenInfo::name);
  if (info == declared.end()) refuse_unknown("", {entry->value.text, entry->value.place}, "entry", names_of(declared));
  const double age_s = number_in(object, "age_s", 0, perception_age_max_s);
  Observation made{.entry = static_cast<std::uint32_t>(info - declared.begin()),
                   .time_ns = now_ns - std::llround(1e9 * age_s),
                   .source = SeenSource::perception};
  if (object.find("confidence") != nullptr) made.confidence = number_in(object, "confidence", 0, 1);
  std::size_t known = 2 + (object.find("confidence") != nullptr ? 1 : 0);
  for (std::size_t i = 0; i < info->fields.size(); ++i, ++known)
    made.fields[i] = number_in(object, info->fields[i].name, info->fields[i].min, info->fields[i].max);
  if (object.members.size() > known) wrong(object, "entry '" + info->name + "' has keys that it does not know");
  return made;
}

void read_all(const JsonValue& json, const std::vector<SeenInfo>& declared, std::int64_t now_ns,
              std::vector<Observation>& observations) {
  if (json.kind != Kind::object) wrong(json, "a datagram is one object");
  (void)number_in(json, "kadans", 1, 1);
  const JsonMember* seen = json.find("seen");
  if (seen == nullptr || seen->value.kind != Kind::array) wrong(json, "'seen' is a list of what is seen");
  if (json.members.size() > 2) wrong(json, "it has keys other than kadans and seen");
  if (seen->value.items.size() > perception_seen_max)
    wrong(seen->value, "it lists more than " + std::to_string(perception_seen_max));
  for (const JsonValue& one : seen->value.items) observations.push_back(one_seen(one, declared, now_ns));
}

}  // namespace

std::string read_perception(std::string_view datagram, const std::vector<SeenInfo>& declared, std::int64_t now_ns,
                            std::vector<Observation>& observations) {
  const std::size_t before = observations.size();
  if (datagram.size() > perception_bytes_max)
    return "it is longer than " + std::to_string(perception_bytes_max) + " bytes";
  try {
    read_all(parse_json(datagram, ""), declared, now_ns, observations);
    return "";
  } catch (const InputError& error) {
    observations.resize(before);
    return error.problems().front().text();
  }
}

}  // namespace kadans
