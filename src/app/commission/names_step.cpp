// Which drive is which joint.
#include <algorithm>
#include <cmath>
#include <map>

#include "app/bench/wiggle.h"
#include "commission_steps.h"
#include "signal/number_text.h"

namespace kadans {
namespace {

constexpr const char* nothing_moved = "none";

struct Moved {
  std::string joint;    // that the person saw
  std::string seen_by;  // the drive whose encoder answered
};

// Its own encoder where that answers nearly as far as any other: other joints may swing with it.
// Of a drive that is coupled with another one the two are compared: what one pushes turns both.
std::size_t answering(const CommissionStep& step, const Wiggle& wiggle, std::size_t own) {
  const std::size_t joints = step.robot.model.joints.size();
  const auto& answers = wiggle.answers_rad();
  std::size_t most = own;
  for (std::size_t i = 0; i < joints; ++i) {
    if (std::abs(answers[i]) > std::abs(answers[most])) most = i;
  }
  const Transmission* const pair = step.robot.model.coupling_of(own);
  if (pair != nullptr && pair == step.robot.model.coupling_of(most)) return most;
  return std::abs(answers[own]) > 0.5 * std::abs(answers[most]) ? own : most;
}

// Two drives move two joints, and one of these stood still: then both drives turn as far.
bool alike(const CommissionStep& step, const Wiggle& wiggle, std::size_t own) {
  const Transmission* const pair = step.robot.model.coupling_of(own);
  if (pair == nullptr || !wiggle.seen()) return false;
  const double one = std::abs(wiggle.answers_rad()[pair->joints()[0]]);
  const double other = std::abs(wiggle.answers_rad()[pair->joints()[1]]);
  return std::min(one, other) > 0.75 * std::max(one, other);
}

std::string what_holds(const CommissionStep& step, const std::string& drive, const Wiggle& wiggle) {
  const double effort_Nm = wiggle.effort_Nm();
  std::string text = "drive '" + drive + "' pushed with " + number_text(std::round(1000 * effort_Nm) / 1000) +
                     " Nm, and nothing moved";
  const std::string brake = step.wiring.value(drive, "brake");
  if (step.wiring.fields().encoder.empty() && wiggle.told_Nm() > 0.3 * effort_Nm) {
    text += ": its motor gets its current, so something holds the joint: a brake that is stuck, or a hard stop";
  } else if (!brake.empty()) {
    text += ": its brake at pin " + brake + " is stuck, or its motor gets no current";
  } else {
    text += ": a brake that is stuck holds the joint, or its motor gets no current";
  }
  return text + "; where friction alone holds it, a greater --share moves it";
}

// False: this drive is not named.
bool name_drive(CommissionStep& step, std::size_t drive, const std::vector<double>& inertia_kg_m2,
                std::map<std::string, Moved>& moved) {
  BenchSession& session = step.session;
  const std::string name = step.drive_name(drive);
  const std::size_t joints = step.robot.model.joints.size();
  Wiggle wiggle({.joint = drive,
                 .inertia_kg_m2 = inertia_kg_m2[drive],
                 .least_inertia_kg_m2 = *std::ranges::min_element(inertia_kg_m2),
                 .effort_max_Nm = session.effort_max_Nm(drive),
                 .joints = joints});
  const std::string stop = session.hold({.about = Question::About::which_joint,
                                         .joint = name,
                                         .text = "Drive '" + name + "' (" + step.wiring.told(name) +
                                                 ") wiggles while a key is held: look which joint moves"},
                                        drive, wiggle);
  if (!stop.empty()) {
    step.problem("drive '" + name + "': " + stop);
    return false;
  }
  Question which{.about = Question::About::which_joint, .joint = name, .text = "Which joint moved?", .answers = {}};
  for (std::size_t i = 0; i < joints; ++i) {
    if (step.robot.model.joints[i].passive()) continue;
    which.answers.push_back(step.drive_name(i));
    if (step.robot.model.coupling_of(i) != nullptr)
      which.text += " '" + step.drive_name(i) + "': " + positive_turn_of_drive(step.robot.model, i) +
                    ", or all of it the other way.";
  }
  which.answers.emplace_back(nothing_moved);
  const std::string joint = session.ask(which);
  if (alike(step, wiggle, drive)) {
    step.problem("drive '" + name + "' turned one of its two joints alone, so that it cannot be told from the other " +
                 "drive: bring both joints to where they are free");
    return false;
  }
  const std::size_t seen_by = answering(step, wiggle, drive);
  if (joint == nothing_moved) {
    if (wiggle.seen()) {
      step.problem("drive '" + name + "' was pushed and nothing moved, but encoder '" + step.drive_name(seen_by) +
                   "' turned by " + degrees_text(wiggle.answers_rad()[seen_by]) +
                   ": the motor turns without its joint; look at the coupling between them");
    } else {
      step.problem(what_holds(step, name, wiggle));
    }
    return false;
  }
  if (!wiggle.seen()) {
    step.problem("joint '" + joint + "' moved, and no encoder did: the encoder of '" + joint +
                 "' is dead; look at its cable, its supply and its light");
    return false;
  }
  for (const auto& [other, its] : moved) {
    if (its.joint != joint) continue;
    step.problem("drives '" + other + "' and '" + name + "' both moved joint '" + joint +
                 "': one of these answers is wrong");
    return false;
  }
  moved[name] = {joint, step.drive_name(seen_by)};
  step.done(drive, joint + " " + step.drive_name(seen_by));
  const bool coupled = step.robot.model.coupling_of(drive) != nullptr;
  session.tell("drive '" + name + (coupled ? "' turns as '" : "' moves joint '") + joint + (coupled ? "' shall" : "'") +
               ", seen by encoder '" + step.drive_name(seen_by) + "'");
  return true;
}

// Fields of one drive's wiring become another's. False: the configuration has no way to say it.
bool take_fields(CommissionStep& step, const Wiring& before, const std::vector<std::string_view>& fields,
                 const std::string& from, const std::string& to) {
  for (const std::string_view field : fields) {
    const std::string is = before.value(from, field), was = before.value(to, field);
    if (is == was) continue;
    if (is.empty() && (field == "pwm" || field == "encoder" || field == "output")) {
      step.problem("drives '" + from + "' and '" + to + "' are swapped, but only one has a field '" +
                   std::string(field) + "': write their entries yourself");
      return false;
    }
    step.wiring.set(to, field, is.empty() ? "\"\"" : is);
  }
  return true;
}

bool write_names(CommissionStep& step, const std::map<std::string, Moved>& moved) {
  const DriveWiringFields& fields = step.wiring.fields();
  const Wiring before = step.wiring;
  std::vector<std::string> sentences;
  for (const auto& [drive, its] : moved) {
    if (its.joint == drive && its.seen_by == drive) continue;
    if (fields.encoder.empty() && its.seen_by != drive) {
      step.problem("servo of '" + drive + "' was pushed, and that of '" + its.seen_by +
                   "' turned: two servos may have the same id, or both sit on one joint");
      return false;
    }
    if (its.seen_by != drive && before.value(drive, "board") != before.value(its.seen_by, "board")) {
      step.problem("joint '" + its.joint +
                   "' has its motor at one board and its encoder at another: they need one board");
      return false;
    }
    const bool good = take_fields(step, before, fields.both, drive, its.joint) &&
                      take_fields(step, before, fields.motor, drive, its.joint) &&
                      take_fields(step, before, fields.encoder, its.seen_by, its.joint);
    if (!good) return false;
    if (its.joint == drive) {
      sentences.push_back("encoders are swapped: joint '" + its.joint + "' is seen by that of '" + its.seen_by + "'");
    } else if (its.joint == its.seen_by) {
      sentences.push_back("motors are swapped: joint '" + its.joint + "' is moved by that of '" + drive + "'");
    } else {
      sentences.push_back("joint '" + its.joint + "' is moved by what is written for '" + drive + "'");
    }
  }
  for (const std::string& one : sentences) step.session.tell(one + ": corrected");
  step.wiring.write();
  return true;
}

}  // namespace

void find_names(CommissionStep& step) {
  const std::vector<double> inertia_kg_m2 = inertias_kg_m2(step.robot, true);
  std::map<std::string, Moved> moved;
  bool all = true;
  for (std::size_t i = 0; i < step.robot.model.joints.size(); ++i) {
    const std::string& name = step.drive_name(i);
    if (!step.progress.done(step.name, step.joint_name(i))) continue;
    const std::string found = step.progress.found(step.name, step.joint_name(i));
    const std::size_t blank = found.find(' ');
    moved[name] = {found.substr(0, blank), found.substr(std::min(found.size(), blank + 1))};
  }
  for (const std::size_t drive : step.joints) all = name_drive(step, drive, inertia_kg_m2, moved) && all;
  if (!all) return;
  // Written once, as a whole: else names would be half exchanged.
  if (!step.progress.done("written", "names") && write_names(step, moved)) step.progress.set("written", "names", "yes");
}

}  // namespace kadans
