// Checks literal arguments of calls in the text: names of poses, set-points, presets, parameters and joints, and the
// ranges of numbers.
#pragma once

#include <string>
#include <vector>

#include "script/behavior/behavior_parts.h"
#include "script/motion/motion_options.h"
#include "source_lexer.h"

namespace kadans {

struct ArgumentProblem {
  int line = 0;
  std::string message;
};

class ArgumentCheck {
 public:
  explicit ArgumentCheck(const Behavior::Parts& parts) : catalog_(parts.catalog) {}

  const ObjectInfo* object(const std::string& name) const noexcept;
  // `at` is the index of the first token of the arguments.
  std::vector<ArgumentProblem> pose_name(const Tokens& tokens, std::size_t at) const;
  std::vector<ArgumentProblem> of_method(const ObjectInfo& object, const std::string& method, const Tokens& tokens,
                                         std::size_t at) const;

 private:
  struct Range {
    std::string name, unit;
    double min = 0, max = 0;
  };
  // `offsets`: the numbers are relative to values that are unknown here.
  std::vector<ArgumentProblem> pose(const ObjectInfo& object, const Tokens& tokens, std::size_t at, bool offsets) const;
  std::vector<ArgumentProblem> pose_table(const ObjectInfo& object, const Tokens& tokens, std::size_t at,
                                          bool offsets) const;
  static std::vector<ArgumentProblem> task_table(const ObjectInfo& object, const std::vector<Range>& ranges,
                                                 const Tokens& tokens, std::size_t at);
  std::vector<ArgumentProblem> named_value(const ObjectInfo& object, const std::vector<Range>& ranges,
                                           const std::string& kind, const Tokens& tokens, std::size_t at,
                                           bool offset = false) const;
  std::vector<ArgumentProblem> of_motion(const ObjectInfo& object, const MotionMethod& method, const Tokens& tokens,
                                         std::size_t at) const;
  std::vector<ArgumentProblem> points(const ObjectInfo& object, const Tokens& tokens, std::size_t at,
                                      bool offsets) const;
  std::vector<ArgumentProblem> preset(const ObjectInfo& object, const Tokens& tokens, std::size_t at) const;
  template <typename Named>
  static Range range_of(const ObjectInfo& object, const Named& one);  // of a Setpoint or a Parameter
  std::vector<Range> setpoints(const ObjectInfo& object) const;
  std::vector<Range> parameters(const ObjectInfo& object) const;

  const Catalog& catalog_;
};

}  // namespace kadans
