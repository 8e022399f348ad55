#include "behavior_tables.h"

#include "signal/byte_order.h"

namespace kadans {
namespace {

// One list of fields for both directions: Put appends them, Take reads them.
struct Put {
  ByteWriter& bytes;

  void operator()(const std::string& text) { bytes.put_string(text); }
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

template <typename T>
void Put::part(const T& one) {
  fields(one, *this);
}

template <typename T>
void Take::part(T& one) {
  fields(one, *this);
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

}  // namespace kadans
