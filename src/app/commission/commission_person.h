// The persons of `kadans commission`: one at a terminal, and one who has written down what to say.
//
// Lines: an answer to each question, in their order; `hold` holds the key for as long as there is something to see,
// `hold 0.5` for half a second. Empty lines and those that begin with # say nothing.
#pragma once

#include <deque>
#include <memory>
#include <string>

#include "app/bench/keys.h"
#include "person.h"

namespace kadans {

// Of the standard input. While the joint may move, any key but Enter and q counts as held for hold_ns; Enter says that
// it has been seen, q ends.
class TerminalPerson final : public Person {
 public:
  void hear(const std::string& sentence) override;
  void ask(const Question& question) override;
  void ask_to_hold(const Question& question) override;
  std::optional<std::string> answer(std::int64_t now_ns) override;
  Hand hand(std::int64_t now_ns, bool complete) override;
  bool gone() override;

 private:
  static constexpr std::int64_t hold_ns = 150'000'000;

  Keys keys_;
  std::string line_;
  std::int64_t until_ns_ = 0;
  bool gone_ = false, told_complete_ = false;
};

class WrittenPerson final : public Person {
 public:
  // A file of lines, or "" for the standard input, whose end is the end. Throws InputError.
  explicit WrittenPerson(const std::string& file);

  void hear(const std::string& sentence) override;
  void ask(const Question& question) override;
  void ask_to_hold(const Question& question) override;
  std::optional<std::string> answer(std::int64_t now_ns) override;
  Hand hand(std::int64_t now_ns, bool complete) override;
  bool gone() override;

 private:
  std::optional<std::string> next();
  void take(std::string_view text);

  std::deque<std::string> lines_;
  std::string begun_;           // a line of the standard input that has no end yet
  std::unique_ptr<Keys> keys_;  // nullptr: there is a file
  bool asked_ = false, lines_end_ = false;
  std::optional<std::int64_t> held_from_ns_;
  double holds_s_ = 0;
};

}  // namespace kadans
