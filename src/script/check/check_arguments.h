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

using Mistakes = std::vector<ArgumentProblem>;

class ArgumentCheck {
 public:
  explicit ArgumentCheck(const Behavior::Parts& parts) : catalog_(parts.catalog) {}

  const ObjectInfo* object(const std::string& name) const noexcept;
  // `at` is the index of the first token of the arguments.
  Mistakes pose_name(const Tokens& tokens, std::size_t at) const;
  Mistakes of_method(const ObjectInfo& object, const std::string& method, const Tokens& tokens, std::size_t at) const;

 private:
  struct Range {
    std::string name, unit;
    double min = 0, max = 0;
  };
  // `offsets`: the numbers are relative to values that are unknown here.
  Mistakes pose(const ObjectInfo& object, const Tokens& tokens, std::size_t at, bool offsets) const;
  Mistakes pose_table(const ObjectInfo& object, const Tokens& tokens, std::size_t at, bool offsets) const;
  static Mistakes task_table(const ObjectInfo& object, const std::vector<Range>& ranges, const Tokens& tokens,
                             std::size_t at);
  Mistakes named_value(const ObjectInfo& object, const std::vector<Range>& ranges, const std::string& kind,
                       const Tokens& tokens, std::size_t at, bool offset = false) const;
  Mistakes of_motion(const ObjectInfo& object, const MotionMethod& method, const Tokens& tokens, std::size_t at) const;
  Mistakes points(const ObjectInfo& object, const Tokens& tokens, std::size_t at, bool offsets) const;
  Mistakes preset(const ObjectInfo& object, const Tokens& tokens, std::size_t at) const;
  template <typename Named>
  static Range range_of(const ObjectInfo& object, const Named& one);  // of a Setpoint or a Parameter
  std::vector<Range> setpoints(const ObjectInfo& object) const;
  std::vector<Range> parameters(const ObjectInfo& object) const;

  const Catalog& catalog_;
};

}  // namespace kadans
