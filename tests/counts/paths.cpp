#include "paths.h"

#include <array>
#include <memory>

#include "app/assembly/assembly.h"
#include "bench/chart_rig.h"
#include "bench/control/body_rig.h"
#include "bench/control/chain_rig.h"
#include "bench/plant/engines.h"
#include "bench/plant/standing.h"
#include "telemetry/record/recorder.h"

using Element = std::array<std::uint64_t, 64>;  // 512 bytes
using Queue = kadans::Ring<Element, 64>;
using Newest = kadans::Latest<Element>;

// Both are templates, which the compiler would merge with whoever calls them.
extern "C" {
[[gnu::noinline]] void kadans_queue_push_pop(Queue& queue, Element& element) {
  (void)queue.try_push(element);
  (void)queue.try_pop(element);
}
[[gnu::noinline]] void kadans_newest_write_read(Newest& newest, Element& element) {
  newest.publish(element);
  const auto reading = newest.read();
  element = *reading;
}
}

namespace kadans::counts {
namespace {

using namespace bench;

constexpr std::int64_t period_ns = 1'000'000;
constexpr int ticks_per_behavior_tick = 10;

Robot tulip() { return read_robot(KADANS_SOURCE_DIR "/config/tulip/robot.json"); }

// Estimate, safety, 14 PID, snapshot, record.
void control_ticks(int calls) {
  ChainRig rig(14, tulip().types);
  Recorder recorder(rig.catalog.signals);
  rig.control.record_to(&recorder);
  for (int i = 0; i < calls; ++i) {
    if (i % ticks_per_behavior_tick == 0) rig.behaviors.tick(i * period_ns);
    rig.control.tick(i * period_ns, 1e-9 * period_ns);
    rig.plant.step(period_ns);
  }
  expect_normal(rig.control);
}

void standing_steps(int calls) {
  const StandingRobot robot = standing_tulip();
  const auto plant = kadans_engine(robot.model, robot.settings, ContactSolver::tree);
  for (int i = 0; i < calls; ++i) {
    plant->set_torques(hold_torques(robot.model, plant->state(), 0));
    plant->step();
  }
}

void behavior_ticks(int calls) {
  Played played(ring(0.095, true));
  for (int i = 0; i < calls; ++i) played.tick();
}

void records(int calls) {
  ChainRig rig(14, tulip().types);
  Recorder recorder(rig.catalog.signals);
  const std::vector<double> row(rig.catalog.signals.size(), 0.5);
  for (int i = 0; i < calls; ++i) recorder.record(static_cast<std::uint64_t>(i), i * period_ns, row);
}

void queue_elements(int calls) {
  const auto queue = std::make_unique<Queue>();
  Element element{};
  for (int i = 0; i < calls; ++i) kadans_queue_push_pop(*queue, element);
}

void newest_values(int calls) {
  const auto newest = std::make_unique<Newest>();
  Element element{};
  for (int i = 0; i < calls; ++i) kadans_newest_write_read(*newest, element);
}

// The whole body sinks, shifts its weight and leans: of ten ticks of its low level one of its high level, or a
// question.
void body_updates(int calls) {
  BodyRig rig;
  for (int i = 0; i < calls; ++i) rig.tick();
}

void body_steps(int calls) { body_updates(calls / ticks_per_behavior_tick); }

void body_questions(int calls) {
  BodyRig rig;
  for (int i = 0; i < calls; ++i) rig.foresee();
}

// Everything at once: the squat, its plant, control objects and behavior.
void simulated_ms(int calls) {
  const ScenarioConfig scenario = read_scenario_config(KADANS_SOURCE_DIR "/config/scenarios/squat.json");
  RunLog log;
  Assembly robot(scenario, 1, log);
  for (int i = 0; i < calls; ++i) robot.parts().lockstep.step();
}

// A * stands for arguments whose types have other names on i386.
constexpr Path all[] = {
    {"control_tick_14", "kadans::ControlEngine::tick(*)", 500, control_ticks},
    {"plant_step_standing", "kadans::BulletWorld::step(*)", 1000, standing_steps},
    {"contact_solver_standing",
     "kadans::bullet::TreeSolver::solveMultiBodyGroup(btCollisionObject**, int, btPersistentManifold**, int, "
     "btTypedConstraint**, int, btMultiBodyConstraint**, int, btContactSolverInfo const&, btIDebugDraw*, "
     "btDispatcher*)",
     1000, standing_steps},
    {"behavior_tick", "kadans::Behavior::tick(kadans::Snapshot const&, kadans::CommandSender&)", 500, behavior_ticks},
    {"whole_body_update", "kadans::WholeBody::update(kadans::Snapshot const&)", 300, body_updates},
    {"whole_body_step", "kadans::WholeBody::step(kadans::ControlInput const&, kadans::ActuationFrame&)", 1000,
     body_steps},
    {"whole_body_foresight", "kadans::BodyReach::miss(kadans::Foresight::Asked const&, kadans::Snapshot const&)", 50,
     body_questions},
    {"record_tick", "kadans::Recorder::record(*)", 500, records},
    {"queue_push_pop", "kadans_queue_push_pop", 1000, queue_elements},
    {"newest_write_read", "kadans_newest_write_read", 1000, newest_values},
    {"simulated_ms_squat", "kadans::Lockstep::step()", 500, simulated_ms},
};

}  // namespace

std::span<const Path> paths() { return all; }

}  // namespace kadans::counts
