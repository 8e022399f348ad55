#include "world_config.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <initializer_list>

#include "kadans/model/kinematics.h"
#include "kadans/signal/nearest_name.h"

namespace kadans {
namespace {

enum class ObjectKind : std::uint8_t { box, ramp, stairs, wall, ball, pendulum, ground, markings, payload };
const std::array<std::string, 9> part_kinds{"box",      "ramp",   "stairs",   "wall",   "ball",
                                            "pendulum", "ground", "markings", "payload"};

constexpr double unset = std::numeric_limits<double>::quiet_NaN();
constexpr NumberRange anywhere_m{-1000, 1000, "m"}, size_m{1e-3, 1000, "m"}, time_s{0, 1e6, "s"}, mass{1e-4, 1e4, "kg"};
constexpr NumberRange velocity_m_s{-100, 100, "m/s"}, slope_rad{-1.2, 1.2, "rad"};

// An entry's fields, of whatever kind. Most defaults are the pendulum's, which the RoboCup rules give.
struct Entry {
  ObjectKind kind = ObjectKind::box;
  std::string name, link;
  Vec3 size_m{}, position_m{}, angles_rad{}, velocity_m_s{}, point_m{};
  double length_m = unset, width_m = unset, height_m = unset, thickness_m = 0.1, incline_rad = unset;
  double rise_m = unset, run_m = unset, radius_m = unset, mass_kg = unset, distance_m = unset;
  double friction = 1, rolling_friction_m = 0, restitution = 0;
  double slope_rad = 0, slope_heading_rad = 0;
  double release_s = 0, from_s = 0, until_s = std::numeric_limits<double>::infinity();
  std::uint32_t count = 1;
  MotionSettings motion;
  GroundMarkings markings;
  std::vector<ObjectCarry> carried;
};

// Lists the fields of one entry: those of its kind, or all when there is no file, or no kind that we know.
class EntryReader {
 public:
  EntryReader(Fields& f, Entry& entry) : f_(f), entry_(entry) {}

  bool read() {
    const bool known = f_.choice("kind", entry_.kind, part_kinds, "kind of object", Need::required);
    all_ = !known;
    if (known && entry_.kind == ObjectKind::pendulum) entry_.length_m = 1.5, entry_.radius_m = 0.1, entry_.mass_kg = 2;
    placing();
    sizes();
    moving();
    painted();
    return known;
  }

 private:
  bool of(std::initializer_list<ObjectKind> kinds) const {
    return all_ || std::find(kinds.begin(), kinds.end(), entry_.kind) != kinds.end();
  }
  // Required of these kinds, optional of the others that have it.
  Need need(std::initializer_list<ObjectKind> kinds) const {
    return !all_ && of(kinds) ? Need::required : Need::optional;
  }
  Need needed() const { return all_ ? Need::optional : Need::required; }

  void placing() {
    using enum ObjectKind;
    if (of({box, ramp, stairs, wall, ball, pendulum, payload})) {
      f_.string("name", entry_.name, "name of the object in signals and messages", needed());
    }
    if (of({box, ramp, stairs, wall, ball, pendulum})) {
      f_.numbers("position_m", entry_.position_m, anywhere_m,
                 "centre of a box or ball, foot of a ramp, stairs or wall, the bob's centre at rest", needed());
      f_.numbers("roll_pitch_yaw_rad", entry_.angles_rad, {-7, 7, "rad"},
                 "orientation; ramps and stairs rise along its x axis, a wall stands across that axis, a pendulum "
                 "swings along it");
      f_.number(
          "friction", entry_.friction, {0, 10},
          "coefficient of friction of its surface; a contact's coefficient is the product of those of both surfaces");
    }
  }

  void sizes() {
    using enum ObjectKind;
    if (of({box})) f_.numbers("size_m", entry_.size_m, size_m, "full edge lengths", needed());
    if (of({ramp, pendulum}))
      f_.number("length_m", entry_.length_m, size_m, "length along the ramp, or from hinge to bob", need({ramp}));
    if (of({ramp, stairs, wall})) f_.number("width_m", entry_.width_m, size_m, "across", needed());
    if (of({wall})) f_.number("height_m", entry_.height_m, size_m, "height of the wall", needed());
    if (of({wall})) f_.number("thickness_m", entry_.thickness_m, size_m, "thickness of the wall");
    if (of({ramp})) f_.number("incline_rad", entry_.incline_rad, slope_rad, "slope of the ramp", needed());
    if (of({stairs})) {
      f_.integer("count", entry_.count, {1, max_stairs}, "number of steps", needed());
      f_.number("rise_m", entry_.rise_m, size_m, "height of a step", needed());
      f_.number("run_m", entry_.run_m, size_m, "depth of a step", needed());
    }
    if (of({ball, pendulum})) f_.number("radius_m", entry_.radius_m, size_m, "radius of the ball or bob", need({ball}));
    if (of({box, ball, pendulum, payload}))
      f_.number("mass_kg", entry_.mass_kg, mass, "mass; a box without mass is fixed", need({ball, payload}));
  }

  void moving() {
    using enum ObjectKind;
    if (of({ball})) {
      f_.number("rolling_friction_m", entry_.rolling_friction_m, {0, 1, "m"}, "lever arm of the rolling resistance");
      f_.number("restitution", entry_.restitution, {0, 1}, "share of the speed that remains after a bounce");
    }
    if (of({box, ball}))
      f_.numbers("velocity_m_s", entry_.velocity_m_s, velocity_m_s, "velocity at the start, for a free object");
    if (of({box, ball}))
      f_.list("carried", {0, 1000}, "a person puts a free object elsewhere, at rest", entry_.carried,
              [](Fields& e, ObjectCarry& carry) {
                e.number("at_s", carry.at_s, time_s, "time", Need::required);
                e.numbers("to_m", carry.to_m, anywhere_m, "its centre then", Need::required);
              });
    if (of({pendulum})) {
      f_.number("distance_m", entry_.distance_m, {0, 1000, "m"}, "horizontal distance to which the bob is drawn back",
                needed());
      f_.number("release_s", entry_.release_s, time_s, "time at which the bob is let go");
    }
    if (of({ground})) {
      f_.number("slope_rad", entry_.slope_rad, slope_rad, "slope of the ground");
      f_.number("slope_heading_rad", entry_.slope_heading_rad, {-7, 7, "rad"},
                "direction in which the ground rises; 0: along x");
    }
    if (of({payload})) {
      f_.string("link", entry_.link, "the link that carries it", needed());
      f_.numbers("point_m", entry_.point_m, anywhere_m, "position in the link's frame");
      f_.number("from_s", entry_.from_s, time_s, "time from which it is carried");
      f_.number("until_s", entry_.until_s, time_s, "time until which it is carried (default: the end)");
    }
    if (of({box, ramp, stairs, wall, ground})) {
      f_.object("motion", "prescribed motion, which no load changes", [&](Fields& e) { motion(e); });
    }
  }

  void painted() {
    if (!of({ObjectKind::markings})) return;
    f_.number("line_m", entry_.markings.line_m, size_m, "width of the painted lines");
    f_.list("lines", {0, 1000}, "straight lines on the ground", entry_.markings.lines,
            [](Fields& e, GroundMarkings::Line& line) {
              e.numbers("from_m", line.from_m, anywhere_m, "x and y of its beginning, in the ground's plane",
                        Need::required);
              e.numbers("to_m", line.to_m, anywhere_m, "x and y of its end", Need::required);
            });
    f_.list("arcs", {0, 1000}, "circles on the ground, or parts of them", entry_.markings.arcs,
            [](Fields& e, GroundMarkings::Arc& arc) {
              e.numbers("center_m", arc.center_m, anywhere_m, "x and y of its centre, in the ground's plane",
                        Need::required);
              e.number("radius_m", arc.radius_m, size_m, "to the middle of the line", Need::required);
              e.number("from_rad", arc.from_rad, {-7, 7, "rad"}, "where it begins, from x towards y");
              e.number("to_rad", arc.to_rad, {-7, 7, "rad"}, "where it ends (default: all around)");
              if (e.reading() && !(arc.to_rad > arc.from_rad)) {
                e.refuse(e.place(e.has("to_rad") ? "to_rad" : "from_rad"),
                         e.path("to_rad") + " is " + number_text(arc.to_rad) + ", must be more than from_rad, " +
                             number_text(arc.from_rad) + " rad");
              }
            });
  }

  void motion(Fields& f) {
    f.list(
        "profile", {1, 10'000}, "velocity over time, linear between these points",
        [&](Fields& e) {
          MotionSettings::Knot knot;
          e.number("time_s", knot.time_s, time_s, "time of this point", Need::required);
          e.numbers("velocity_m_s", knot.velocity_m_s, velocity_m_s, "velocity in world axes", Need::required);
          if (!e.reading()) return;
          if (!entry_.motion.knots.empty() && !(knot.time_s > entry_.motion.knots.back().time_s)) {
            e.refuse("time_s", knot.time_s,
                     "later than the one before, " + number_text(entry_.motion.knots.back().time_s) + " s");
          }
          entry_.motion.knots.push_back(knot);
        },
        Need::required);
    f.boolean("repeat", entry_.motion.repeat, "the profile begins again after its last point");
    f.boolean("conveyor", entry_.motion.conveyor, "the surface moves and the object stays in its place");
  }

  Fields& f_;
  Entry& entry_;
  bool all_ = false;
};

// What the fields alone cannot say.
void verify(const Fields& f, const Entry& entry) {
  if (f.has("name") && !is_word(entry.name)) {
    f.refuse("name", ": " + in_quotes(entry.name) +
                         " must be a word of letters, digits and '_', it becomes part of signals' names");
  }
  if (entry.kind == ObjectKind::pendulum && !(entry.distance_m < entry.length_m) && f.has("distance_m")) {
    f.refuse("distance_m", entry.distance_m, "less than length_m, " + number_text(entry.length_m) + " m");
  }
  if (entry.kind == ObjectKind::payload && !(entry.until_s > entry.from_s)) {
    f.refuse("until_s", entry.until_s, "later than from_s, " + number_text(entry.from_s) + " s");
  }
  if (entry.kind != ObjectKind::box) return;
  if (f.has("mass_kg") && f.has("motion")) {
    f.refuse("motion", ": a box with a mass moves freely and cannot be driven");
  }
  for (const std::string key : {"velocity_m_s", "carried"}) {
    if (!f.has("mass_kg") && f.has(key)) f.refuse(key, " means nothing: a box without mass_kg is fixed");
  }
}

WorldShape shape_of(const Entry& e) {
  switch (e.kind) {
    case ObjectKind::ramp:
      return WorldRamp{e.length_m, e.width_m, e.incline_rad};
    case ObjectKind::stairs:
      return WorldStairs{e.count, e.rise_m, e.run_m, e.width_m};
    case ObjectKind::wall:
      return WorldWall{e.width_m, e.height_m, e.thickness_m};
    case ObjectKind::ball:
      return WorldBall{e.radius_m, e.mass_kg, e.rolling_friction_m, e.restitution, e.velocity_m_s};
    case ObjectKind::pendulum:
      return WorldPendulum{e.length_m, e.radius_m, e.mass_kg, e.distance_m, e.release_s};
    default:
      return WorldBox{e.size_m, std::isnan(e.mass_kg) ? 0 : e.mass_kg, e.velocity_m_s};
  }
}

void add(const Fields& f, const Entry& entry, WorldConfig& world) {
  WorldSettings& settings = world.settings;
  if (entry.kind == ObjectKind::ground) {
    settings.slope_rad = entry.slope_rad;
    settings.slope_heading_rad = entry.slope_heading_rad;
    settings.ground_motion = entry.motion;
  } else if (entry.kind == ObjectKind::markings) {
    settings.markings.push_back(entry.markings);
  } else if (entry.kind == ObjectKind::payload) {
    settings.payloads.push_back({entry.name, entry.link, entry.point_m, entry.mass_kg, entry.from_s, entry.until_s});
    world.payload_links.push_back(f.place("link"));
  } else {
    const auto& [roll_rad, pitch_rad, yaw_rad] = entry.angles_rad;
    const Pose pose{entry.position_m, from_roll_pitch_yaw(roll_rad, pitch_rad, yaw_rad)};
    for (ObjectCarry carry : entry.carried) {
      carry.object = settings.objects.size();
      world.carried.push_back(carry);
    }
    settings.objects.push_back({entry.name, shape_of(entry), pose, entry.friction, entry.motion});
  }
}

}  // namespace

void world_fields(Fields& f, WorldConfig& world) {
  std::vector<std::string> names;
  if (f.has("world")) world.place = f.place("world");
  f.list("world", {0, max_world_objects}, "objects around the robot, and loads that it carries", [&](Fields& e) {
    Entry entry;
    const bool known = EntryReader(e, entry).read();
    if (!e.reading() || !known) return;
    verify(e, entry);
    const std::string name = entry.kind == ObjectKind::ground ? "ground" : entry.name;  // "": markings have none
    if (!name.empty() && std::find(names.begin(), names.end(), name) != names.end()) {
      e.refuse(e.place("name"), e.path() + ": another entry is named " + in_quotes(name));
    }
    names.push_back(name);
    add(e, entry, world);
  });
}

const WorldSettings& world_for(const WorldConfig& world, const RobotModel& model, const std::string& file) {
  Problems problems(file);
  for (std::size_t i = 0; i < world.settings.payloads.size(); ++i) {
    const std::string& link = world.settings.payloads[i].link;
    if (!model.find_link(link)) problems.add_unknown(world.payload_links[i], "link", link, model.link_names());
  }
  problems.throw_if_any();
  return world.settings;
}

}  // namespace kadans
