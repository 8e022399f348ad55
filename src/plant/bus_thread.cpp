#include "kadans/plant/bus_thread.h"

#include <string>
#include <utility>

#include "signal/input_file.h"
#include "signal/quiet_thread.h"

namespace kadans {
namespace {

constexpr int bus_thread_priority = 80;
constexpr std::size_t stack_bytes = std::size_t{256} * 1024;

}  // namespace

void BusThread::start(const char* name, const char* whom, std::function<void()> serve) {
  stop();
  serve_ = std::move(serve);
  stop_.store(false, std::memory_order_relaxed);
  runs_ = start_quiet_thread<&BusThread::serve_>(thread_, {name, stack_bytes}, this) == 0;
  if (!runs_) refuse(std::string("the system gives no thread to ") + whom);
  sched_param parameter{};
  parameter.sched_priority = bus_thread_priority;
  (void)pthread_setschedparam(thread_, SCHED_FIFO, &parameter);
}

void BusThread::stop() noexcept {
  ask_to_stop();
  if (std::exchange(runs_, false)) pthread_join(thread_, nullptr);
}

}  // namespace kadans
