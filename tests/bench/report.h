// How the benchmarks measure and what they hand to the table: medians, of many short batches, on whatever the machine
// does beside. Absolute figures belong to the machine; compare within one run.
#pragma once

#include <algorithm>
#include <chrono>
#include <string>
#include <vector>

namespace kadans::bench {

struct Figure {
  std::string key;  // path in the JSON object: "control_tick_ns.14"
  std::string text;
  double value = 0;
  std::string unit;
};

class Report {
 public:
  void add(std::string key, std::string text, double value, std::string unit) {
    figures_.push_back({std::move(key), std::move(text), value, std::move(unit)});
  }
  void print_table() const;
  void print_json() const;

 private:
  std::vector<Figure> figures_;
};

inline double median(std::vector<double> values) {
  if (values.empty()) return 0;
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

inline double now_ns() {
  return static_cast<double>(
      std::chrono::duration_cast<std::chrono::nanoseconds>(std::chrono::steady_clock::now().time_since_epoch())
          .count());
}

// Median time of one call, in ns, from `batches` batches of `calls` calls after a tenth of them to warm up.
template <typename Call>
double time_ns(Call&& call, int calls, int batches = 200) {
  std::vector<double> each;
  for (int batch = -batches / 10; batch < batches; ++batch) {
    const double began = now_ns();
    for (int i = 0; i < calls; ++i) call();
    if (batch >= 0) each.push_back((now_ns() - began) / calls);
  }
  return median(std::move(each));
}

// So that the compiler cannot leave out what computes `value`.
template <typename T>
void keep(T& value) {
  asm volatile("" : : "r"(&value) : "memory");
}

void bench_bus(Report& report);
void bench_body(Report& report);
void bench_control(Report& report);
void bench_exchange(Report& report);
void bench_latency(Report& report);
void bench_live(Report& report);
void bench_lua(Report& report);
void bench_objects(Report& report);
void bench_plant(Report& report);
void bench_precision(Report& report);
void bench_record(Report& report);
void bench_rfsm(Report& report);  // part of bench_lua; nothing without KADANS_RFSM
void bench_simulation(Report& report);
void bench_start(Report& report);
void bench_switch(Report& report);
void bench_wall(Report& report);

}  // namespace kadans::bench
