// Conditions on signals, written in Lua: "plant.base.height_m > 0.6 and abs(base.pitch_rad) < 0.2". And numbers made of
// signals: "sqrt(base.x_m^2 + base.y_m^2)".
//
// A dotted name is a signal; "plant." may be left out when no other signal has the shorter name. With the prefix
// "last." it is the signal's value one tick before (in the first tick the value of that tick). time_s is the time. The
// functions of `math` can be used without its name. state("act.arm.wave") is true while a behavior is in that state,
// and state("greet.act.arm.wave") while the behavior `greet` is; of a further robot `left` state("left.act.arm.wave").
// Where the longest name that stands there is a signal's, it is that one: joint.left-knee.position_rad.
//
// All conditions of a run are in one sandboxed Lua state. They are compiled once and evaluated together, each tick
// under one budget. One thread at a time.
#pragma once

#include <algorithm>
#include <array>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "kadans/signal/signal.h"

struct lua_State;

namespace kadans {

// A state of a behavior, which is active while a signal is in this range.
struct SignalState {
  std::string path;      // "act.arm.wave"
  std::string behavior;  // as in the signal's name
  SignalId signal = 0;
  double first = 0, end = 0;
  std::string robot{};  // a further robot of the scenario; "": the first one

  std::array<std::string, 2> names() const {
    const std::string of = robot.empty() ? "" : robot + ".";
    return {of + path, of + behavior + "." + path};
  }
};

// Why a condition's text is refused.
struct ExpressionError {
  int column = 0;  // 1-based, in the text
  std::string message;

  // The same column where the text stands in a JSON file: quotes before it are escaped there.
  int file_column(std::string_view text) const noexcept {
    const auto before = text.substr(0, static_cast<std::size_t>(column - 1));
    return column + static_cast<int>(std::count(before.begin(), before.end(), '"'));
  }
};

class SignalExpressions {
 public:
  // The table and the states must outlive this object.
  explicit SignalExpressions(const SignalTable& signals, std::span<const SignalState> states = {});
  ~SignalExpressions();
  SignalExpressions(const SignalExpressions&) = delete;
  SignalExpressions& operator=(const SignalExpressions&) = delete;

  enum class Gives : std::uint8_t { condition, number };
  // Before the run. Compiles an expression and gives its index. False: `error` says what is wrong.
  [[nodiscard]] bool add(std::string_view text, std::size_t& index, ExpressionError& error,
                         Gives gives = Gives::condition);
  // The signals in the order of the text, each once.
  std::span<const SignalId> signals_of(std::size_t index) const { return conditions_.at(index).signals; }
  std::size_t size() const noexcept { return conditions_.size(); }

  // Evaluates all on a row of the table. False: one of them failed, see error().
  [[nodiscard]] bool evaluate(double time_s, std::span<const double> row) noexcept;
  // The result of the last evaluation: the number, or 1 for a condition that holds.
  double value(std::size_t index) const { return conditions_.at(index).value; }
  bool holds(std::size_t index) const { return value(index) != 0; }
  const std::string& error() const noexcept { return error_; }
  std::size_t failed() const noexcept { return failed_; }  // which one it is of; size(): of none

 private:
  struct Condition {
    std::string text;
    std::vector<SignalId> signals;
    Gives gives = Gives::condition;
    int function = 0;  // registry reference
    double value = 0;
  };
  struct State;
  bool translate(std::string_view text, Condition& condition, std::string& lua, ExpressionError& error) const;
  bool translate_state(std::string_view text, std::size_t& at, Condition& condition, std::vector<SignalId>& used,
                       std::string& lua, ExpressionError& error) const;
  bool compile(const std::string& lua, Condition& condition, ExpressionError& error);
  void evaluate_all(lua_State* state, double time_s, std::span<const double> row);

  const SignalTable& signals_;
  std::span<const SignalState> states_;
  std::unique_ptr<State> state_;
  std::vector<Condition> conditions_;
  std::vector<SignalId> used_;  // used by any condition
  std::string error_;
  std::size_t failed_ = 0;
};

}  // namespace kadans
