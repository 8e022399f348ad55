#include "based_on.h"

#include <algorithm>

#include "config/robot/project_root.h"

namespace kadans {
namespace {

constexpr const char* base_key = "based_on";

void stand_at(TextPlace place, JsonValue& value) {
  value.place = place;
  for (JsonValue& item : value.items) stand_at(place, item);
  for (JsonMember& member : value.members) {
    member.place = place;
    stand_at(place, member.value);
  }
}

const std::string* name_of(const JsonValue& item) {
  const JsonMember* name = item.kind == JsonValue::Kind::object ? item.find("name") : nullptr;
  return name != nullptr && name->value.kind == JsonValue::Kind::string ? &name->value.text : nullptr;
}

bool named(const JsonValue& list) {
  return list.kind == JsonValue::Kind::array && !list.items.empty() &&
         std::ranges::all_of(list.items, [](const JsonValue& item) { return name_of(item) != nullptr; });
}

void merge(JsonValue& base, const JsonValue& given);

void merge_members(JsonValue& base, const JsonValue& given) {
  for (const JsonMember& member : given.members) {
    const auto found = std::ranges::find(base.members, member.name, &JsonMember::name);
    if (found == base.members.end()) {
      base.members.push_back(member);
    } else {
      found->place = member.place;
      merge(found->value, member.value);
    }
  }
}

// Each item of the base takes one of its name; a second one is left to the reader, which refuses it.
void merge_named(JsonValue& base, const JsonValue& given) {
  std::vector<bool> taken(base.items.size());
  for (const JsonValue& item : given.items) {
    std::size_t at = 0;
    while (at < taken.size() && (taken[at] || *name_of(base.items[at]) != *name_of(item))) ++at;
    if (at < taken.size()) {
      merge(base.items[at], item);
      taken[at] = true;
    } else {
      base.items.push_back(item);
    }
  }
}

void merge(JsonValue& base, const JsonValue& given) {
  if (base.kind == JsonValue::Kind::object && given.kind == JsonValue::Kind::object) {
    base.place = given.place;
    merge_members(base, given);
  } else if (named(base) && named(given)) {
    base.place = given.place;
    merge_named(base, given);
  } else {
    base = given;
  }
}

// What the value is based on; nothing when it does not say so, or not by a name: then its reader refuses it.
const JsonMember* base_of(const JsonValue& value) {
  const JsonMember* base = value.kind == JsonValue::Kind::object ? value.find(base_key) : nullptr;
  return base != nullptr && base->value.kind == JsonValue::Kind::string ? base : nullptr;
}

BasedJson parse(std::string_view text, const std::string& file, std::size_t depth) {
  BasedJson json{.value = parse_json(text, file), .bases = {}};
  const JsonMember* given = base_of(json.value);
  if (given == nullptr) return json;
  const TextPlace place = given->value.place;
  Problems problems(file);
  if (depth == based_on_depth_max)
    problems.add(place, "based_on: more than " + std::to_string(depth) + " files, or one that is based on itself");
  const std::filesystem::path base = resolve_file(given->value.text, place, base_key, problems);
  problems.throw_if_any();
  BasedJson whole = parse(read_input_file(base), base.string(), depth + 1);
  stand_at(place, whole.value);
  merge(whole.value, json.value);
  whole.bases.insert(whole.bases.begin(), base);
  return whole;
}

}  // namespace

BasedJson parse_based_json(std::string_view text, const std::string& file) { return parse(text, file, 0); }

std::vector<std::filesystem::path> files_of(const std::filesystem::path& file) {
  std::vector<std::filesystem::path> files{file};
  try {
    for (const auto& base : parse_based_json(read_input_file(file), file.string()).bases) files.push_back(base);
  } catch (const InputError&) {
    return files;
  }
  return files;
}

}  // namespace kadans
