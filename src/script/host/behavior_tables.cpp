#include "behavior_tables.h"

#include "signal/byte_order.h"

namespace kadans {
namespace {

// One list of fields for both directions: Put appends them, Take reads them.
struct Put {
  ByteWriter& bytes;

  void operator()(const std::string& text) { bytes.put_string(text); }
  void operator()(const std::filesystem::path& file) { bytes.put_string(file.string()); }
  void operator()(const PlayValue& value) {
    bytes.put(static_cast<std::uint8_t>(value.index()));
    std::visit(*this, value);
  }
  template <Number T>
  void operator()(T value) {
    bytes.put(value);
  }
  template <typename T>
  requires std::is_enum_v<T>
  void operator()(T kind) { bytes.put(static_cast<std::uint8_t>(kind)); }
  template <typename T>
  void operator()(const std::vector<T>& all) {
    bytes.put(static_cast<std::uint32_t>(all.size()));
    for (const T& one : all) part(one);
  }
  template <typename T>
  void part(const T& one);
};

struct Take {
  ByteReader& bytes;
  bool known = true;  // no number of a kind is beyond the last

  void operator()(std::string& text) { text = bytes.take_string(); }
  void operator()(std::filesystem::path& file) { file = bytes.take_string(); }
  void operator()(PlayValue& value) {
    const auto index = bytes.take<std::uint8_t>();
    value = index == 0 ? PlayValue(0.0) : index == 1 ? PlayValue(false) : PlayValue(std::string());
    std::visit(*this, value);
  }
  template <Number T>
  void operator()(T& value) {
    if constexpr (std::is_same_v<T, bool>) {
      value = bytes.take<std::uint8_t>() != 0;
    } else {
      value = bytes.take<T>();
    }
  }
  template <typename T>
  void kind(T& value, T last) {
    const auto taken = bytes.take<std::uint8_t>();
    known = known && taken <= static_cast<std::uint8_t>(last);
    value = known ? static_cast<T>(taken) : T{};
  }
  void operator()(ScriptEvent::Field::Type& type) { kind(type, ScriptEvent::Field::Type::text); }
  void operator()(BehaviorQuestion::Kind& of) { kind(of, BehaviorQuestion::Kind::reload); }
  void operator()(PlayOrder::Kind& of) { of = static_cast<PlayOrder::Kind>(bytes.take<std::uint8_t>()); }
  template <typename T>
  void operator()(std::vector<T>& all) {
    for (auto left = bytes.take<std::uint32_t>(); left > 0 && bytes.ok(); --left) part(all.emplace_back());
  }
  template <typename T>
  void part(T& one);
};

template <typename T, typename Whole>
concept Is = std::is_same_v<std::remove_const_t<T>, Whole>;

template <typename Each>
void fields(Is<std::string> auto& entry, Each& each) {
  each(entry);
}

template <typename Each>
void fields(Is<ScriptParameter> auto& p, Each& each) {
  each(p.chunk), each(p.name), each(p.unit), each(p.doc);
  each(p.initial), each(p.min), each(p.max), each(p.value), each(p.loaded);
}

template <typename Each>
void fields(Is<ScriptEvent::Field> auto& f, Each& each) {
  each(f.name), each(f.type), each(f.unit), each(f.doc), each(f.min), each(f.max), each(f.optional);
}

template <typename Each>
void fields(Is<ScriptEvent> auto& e, Each& each) {
  each(e.chunk), each(e.line), each(e.name), each(e.doc), each(e.fields);
}

template <typename Each>
void fields(Is<BehaviorReport> auto& b, Each& each) {
  each(b.name), each(b.outcome), each(b.error), each(b.result), each(b.active), each(b.lane), each(b.over);
  each(b.chart), each(b.parameters), each(b.events);
}

template <typename Each>
void fields(Is<TransitionReason> auto& r, Each& each) {
  each(r.transition), each(r.from), each(r.to), each(r.label), each(r.free), each(r.why), each(r.saw);
  each(r.guard.file), each(r.guard.line), each(r.guard.text);
}

template <typename Each>
void fields(Is<BehaviorReasons> auto& r, Each& each) {
  each(r.name), each(r.transitions);
}

template <typename Each>
void fields(Is<BehaviorQuestion> auto& q, Each& each) {
  each(q.kind), each(q.text), each(q.value);
}

template <typename Each>
void fields(Is<BehaviorReply> auto& r, Each& each) {
  each(r.error), each(r.paused), each(r.behaviors), each(r.reasons), each(r.text), each(r.before), each(r.chunk);
}

template <typename Each>
void fields(Is<PlayArgument> auto& a, Each& each) {
  each(a.name), each(a.value);
}

template <typename Each>
void fields(Is<PlayItem> auto& i, Each& each) {
  each(i.file), each(i.lane), each(i.source), each(i.arguments);
}

template <typename Each>
void fields(Is<PlayedEvent> auto& e, Each& each) {
  each(e.name), each(e.who), each(e.ordered), each(e.data);
}

template <typename Each>
void fields(Is<PlayOrder> auto& o, Each& each) {
  each(o.kind), each(o.behavior.name), each(o.file), each(o.list);
  if (o.kind == PlayOrder::Kind::emit) each.part(o.event);
}

template <typename T>
void Put::part(const T& one) {
  fields(one, *this);
}

template <typename T>
void Take::part(T& one) {
  fields(one, *this);
}

template <typename T>
T taken(ByteReader& bytes) {
  T one{};
  Take{bytes}.part(one);
  return one;
}

template <typename T>
bool take_whole(ByteReader& bytes, T& to) {
  Take take{bytes};
  take.part(to);
  return take.known && bytes.ok();
}

}  // namespace

void put_question(const BehaviorQuestion& question, ByteWriter& bytes) { Put{bytes}.part(question); }
void put_reply(const BehaviorReply& reply, ByteWriter& bytes) { Put{bytes}.part(reply); }
bool take_question(ByteReader& bytes, BehaviorQuestion& question) { return take_whole(bytes, question); }
bool take_reply(ByteReader& bytes, BehaviorReply& reply) { return take_whole(bytes, reply); }

void put_item(const PlayItem& item, ByteWriter& bytes) { Put{bytes}.part(item); }
void put_event(const PlayedEvent& event, ByteWriter& bytes) { Put{bytes}.part(event); }
void put_order(const PlayOrder& order, ByteWriter& bytes) { Put{bytes}.part(order); }
PlayItem take_item(ByteReader& bytes) { return taken<PlayItem>(bytes); }
PlayedEvent take_event(ByteReader& bytes) { return taken<PlayedEvent>(bytes); }
PlayOrder take_order(ByteReader& bytes) { return taken<PlayOrder>(bytes); }

}  // namespace kadans
