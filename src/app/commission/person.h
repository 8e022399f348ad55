// The person before a robot on its bench: hears sentences, answers questions, holds a key while a joint may move.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace kadans {

struct Question {
  enum class About : std::uint8_t {
    which_joint,  // moved, while `joint`'s drive was pushed
    positive,     // did `joint` turn in its positive direction?
    method,       // how is `joint` to be measured?
    number,       // a quantity of `joint`
    ready,        // `joint` is as the text says
    load,         // `joint` is held by hand, and let go while the key is held
    agreed,       // is what was found to be written?
    gains         // which of them?
  };
  About about = About::ready;
  std::string joint;
  std::string text;
  std::vector<std::string> answers{};  // those that are understood; none: any line
};

class Person {
 public:
  virtual ~Person() = default;
  Person() = default;
  Person(const Person&) = delete;
  Person& operator=(const Person&) = delete;

  virtual void hear(const std::string& sentence) = 0;
  virtual void ask(const Question& question) = 0;
  // A joint may move while the key is held; the text says what to look at.
  virtual void ask_to_hold(const Question& question) = 0;

  // Each tick after ask(): the answer, once it is there.
  virtual std::optional<std::string> answer(std::int64_t now_ns) = 0;
  enum class Hand : std::uint8_t { away, holds, done };  // done: it has seen enough
  // Each tick after ask_to_hold(). `complete`: there is nothing more to see.
  virtual Hand hand(std::int64_t now_ns, bool complete) = 0;
  // Nobody is there any more, or whoever is there wants to end.
  virtual bool gone() = 0;
};

}  // namespace kadans
