// Words of other languages, libraries and statechart tools that authors write out of habit, each with what is written
// here instead. Used in messages about unknown names and keys, before a run and in it.
#pragma once

#include <initializer_list>
#include <span>
#include <string_view>

namespace kadans {

// Words with one meaning, and what a message says about them.
struct ForeignWords {
  std::initializer_list<std::string_view> words;
  std::string_view text;
};
std::string_view text_of(std::span<const ForeignWords> table, std::string_view word) noexcept;  // "" for none of them

// How the message about an unknown name goes on, ": Lua writes nil"; "" for a name that is none of these.
std::string_view foreign_name_hint(std::string_view name) noexcept;

// What a key of another statechart language is called here, "when" for "guard"; "" for none of these.
std::string_view foreign_key(std::string_view key) noexcept;

// Whether such a key holds states or transitions, which stand in the table without a key.
bool names_a_list(std::string_view key) noexcept;

// The key before a name that stands in the line without its quotes, "to" of `{ after = 1, to = stand }`; "" for none.
std::string_view unquoted_value_key(std::string_view line, std::string_view name) noexcept;

// How the message about an unknown field of `m`, `s`, `s.event` or `kadans` goes on: names of `m` that are read from
// `s`, or the other way round, stand in the wrong order; others are found elsewhere. "" for none.
std::string_view foreign_field_hint(std::string_view owner, std::string_view field) noexcept;

// How the message about a key that stands for a whole transition goes on: `on_done = ...`; "" for none.
std::string_view foreign_transition(std::string_view key) noexcept;

// What is written for a type of another language where a field of an event has its unit: "k.flag" for "bool"; "" for
// none.
std::string_view foreign_type(std::string_view unit) noexcept;
inline constexpr std::string_view order_hint =
    "; the order is (m, s) in enter, exit, during, run and action, and (s, m) in when";

}  // namespace kadans
