#include "fields.h"

#include <algorithm>

#include "field_text.h"

namespace kadans {
namespace {

using Kind = JsonValue::Kind;

constexpr std::string_view doc_key = "doc";

}  // namespace

std::string Fields::path(std::string_view name) const { return key_path(path_, name); }

TextPlace Fields::place(std::string_view name) const {
  const JsonMember* member = value_ == nullptr ? nullptr : value_->find(name);
  return member == nullptr ? place() : member->value.place;
}

// The value of a field, or null: not given, or there is no file and the field is only described.
const JsonValue* Fields::take(FieldInfo info, Need need) {
  known_.push_back(info.name);
  if (value_ == nullptr) {
    described_->fields.push_back(std::move(info));
    return nullptr;
  }
  const JsonMember* member = value_->find(info.name);
  if (member != nullptr) return &member->value;
  if (need == Need::required) {
    problems_->add(value_->place,
                   "key '" + info.name + "' is missing" + (path_.empty() ? "" : " in " + path_) + with_doc(info.doc));
  }
  return nullptr;
}

void Fields::wrong_type(const JsonValue& value, const std::string& path, const std::string& wanted,
                        std::string_view doc) {
  problems_->add(value.place, path + " must be " + wanted + ", not " + described(value) + with_doc(doc));
}

void Fields::number_entries(std::vector<NumberEntry>& entries, NumberRange range, std::string_view doc) {
  any_key_ = true;
  if (value_ == nullptr) {
    described_->kind = FieldInfo::Kind::map;
    described_->fields.assign(1, number_info("", range, doc, Need::optional));
    return;
  }
  for (const JsonMember& member : value_->members) {
    if (member.name == doc_key) continue;
    NumberEntry entry{member.name, 0, member.place, member.value.place};
    if (read_number(member.value, path(member.name), range, doc, entry.value)) entries.push_back(std::move(entry));
  }
}

void Fields::text_entries(std::vector<TextEntry>& entries, std::string_view doc) {
  any_key_ = true;
  if (value_ == nullptr) {
    described_->kind = FieldInfo::Kind::map;
    described_->fields.assign(1, {.kind = FieldInfo::Kind::string, .doc = std::string(doc)});
    return;
  }
  for (const JsonMember& member : value_->members) {
    if (member.name == doc_key) continue;
    if (member.value.kind == JsonValue::Kind::string) {
      entries.push_back({member.name, member.value.text, member.place, member.value.place});
    } else {
      wrong_type(member.value, path(member.name), "a string", doc);
    }
  }
}

Fields Fields::open_child(const JsonValue& value, std::string path) const {
  Fields child(value, *problems_);
  child.path_ = std::move(path);
  return child;
}

std::vector<Fields> Fields::open(FieldInfo::Kind kind, std::string_view name, std::string_view doc, CountRange count,
                                 Need need) {
  FieldInfo info = info_of(kind, name, doc, need);
  info.count = count;
  if (kind != FieldInfo::Kind::object) info.fields.emplace_back();
  const JsonValue* given = take(std::move(info), need);
  std::vector<Fields> children;
  if (value_ == nullptr) {
    FieldInfo& field = described_->fields.back();
    children.emplace_back(kind == FieldInfo::Kind::object ? field : field.fields.back());
    return children;
  }
  if (given == nullptr) return children;
  const Kind wanted = kind == FieldInfo::Kind::list ? Kind::array : Kind::object;
  if (given->kind != wanted) {
    wrong_type(*given, path(name), wanted == Kind::array ? "an array of objects" : "an object", doc);
    return children;
  }
  if (kind == FieldInfo::Kind::object) children.push_back(open_child(*given, path(name)));
  open_items(kind, *given, path(name), count, doc, children);
  return children;
}

// The objects in an array or in a map.
void Fields::open_items(FieldInfo::Kind kind, const JsonValue& given, const std::string& path, CountRange count,
                        std::string_view doc, std::vector<Fields>& children) {
  const auto open_item = [&](const JsonValue& item, const std::string& item_path) {
    if (item.kind != Kind::object) {
      wrong_type(item, item_path, "an object", doc);
      return false;
    }
    children.push_back(open_child(item, item_path));
    return true;
  };
  if (kind == FieldInfo::Kind::list) {
    if (!(given.items.size() >= count.min && given.items.size() <= count.max)) {
      problems_->add(given.place, path + " " + count_text(given.items.size(), count) + with_doc(doc));
      return;
    }
    for (std::size_t i = 0; i < given.items.size(); ++i) {
      open_item(given.items[i], path + "[" + std::to_string(i) + "]");
    }
  } else if (kind == FieldInfo::Kind::map) {
    for (const JsonMember& member : given.members) {
      if (member.name == doc_key || !open_item(member.value, key_path(path, member.name))) continue;
      children.back().key_ = member.name;
      children.back().key_place_ = member.place;
    }
  }
}

void Fields::finish() {
  if (value_ == nullptr) return;
  for (const JsonMember& member : value_->members) {
    const bool known = any_key_ || std::find(known_.begin(), known_.end(), member.name) != known_.end();
    if (member.name == doc_key) {
      if (member.value.kind != Kind::string) wrong_type(member.value, path(doc_key), "a string", "a note for people");
    } else if (!known) {
      problems_->add_unknown(member.place, "key", member.name, known_, path_.empty() ? "" : "in " + path_);
    }
  }
}

}  // namespace kadans
