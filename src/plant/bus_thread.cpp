#include "kadans/plant/bus_thread.h"

#include <csignal>
#include <string>
#include <utility>

#include "signal/input_file.h"

namespace kadans {
namespace {

constexpr int bus_thread_priority = 80;
constexpr std::size_t stack_bytes = std::size_t{256} * 1024;

}  // namespace

void BusThread::start(const char* name, const char* whom, std::function<void()> serve) {
  stop();
  serve_ = std::move(serve);
  stop_.store(false, std::memory_order_relaxed);
  sigset_t all, before;
  sigfillset(&all);
  pthread_sigmask(SIG_SETMASK, &all, &before);
  pthread_attr_t attributes;
  pthread_attr_init(&attributes);
  pthread_attr_setstacksize(&attributes, stack_bytes);
  runs_ = pthread_create(&thread_, &attributes, enter, this) == 0;
  pthread_attr_destroy(&attributes);
  pthread_sigmask(SIG_SETMASK, &before, nullptr);
  if (!runs_) refuse(std::string("the system gives no thread to ") + whom);
  sched_param parameter{};
  parameter.sched_priority = bus_thread_priority;
  (void)pthread_setschedparam(thread_, SCHED_FIFO, &parameter);
  pthread_setname_np(thread_, name);
}

void BusThread::stop() noexcept {
  ask_to_stop();
  if (std::exchange(runs_, false)) pthread_join(thread_, nullptr);
}

void* BusThread::enter(void* self) {
  static_cast<BusThread*>(self)->serve_();
  return nullptr;
}

}  // namespace kadans
