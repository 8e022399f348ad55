#include "kadans/remote/record_side.h"

#include <algorithm>
#include <ctime>

#include "kadans/signal/input_error.h"

namespace kadans {
namespace {

namespace fs = std::filesystem;

// "tulip_20261121_181500.mcap", in universal time.
std::string dated(const std::string& robot) {
  const std::time_t now = std::time(nullptr);
  std::tm parts{};
  gmtime_r(&now, &parts);
  char text[32];
  std::strftime(text, sizeof text, "_%Y%m%d_%H%M%S.mcap", &parts);
  return robot + text;
}

}  // namespace

void RecordSide::start(const std::string& file) {
  if (!recorder_) recorder_ = std::make_unique<Recorder>(instance_.catalog().signals);
  if (!recorder_->open(file)) throw InputError({.message = recorder_->error()});
  (void)recorder_->describe("run", facts_);
  file_ = file;
  log_.to(&recorder_->events());
  control_.record_to(recorder_.get());
  publish();
}

void RecordSide::leave_to(RecordSink& own, const std::string& file) {
  file_ = file;
  others_ = true;
  control_.record_to(&own);
}

bool RecordSide::stop() {
  if (file_.empty() || others_) return true;
  control_.record_to(nullptr);
  log_.to(nullptr);
  const bool whole = recorder_->close();
  publish();
  file_.clear();
  return whole;
}

bool RecordSide::beat(const Beat&) {
  if (!file_.empty() && !others_) (void)recorder_->drain();  // a disk that fails is told at the end; the robot goes on
  for (const auto& port : instance_.ports()) {
    while (std::unique_ptr<OrderCase> order = port->records_.take()) {
      try {
        carry_out(*order);
      } catch (const std::exception& error) {
        order->answer.text = error.what();
      }
      port->records_.answer(std::move(order));
    }
  }
  publish();
  return true;
}

void RecordSide::carry_out(OrderCase& order) {
  Answer& answer = order.answer;
  if (order.order.kind == Order::Kind::record_start) {
    if (!file_.empty()) throw InputError({.message = "a record goes on already: " + file_});
    const fs::path file = file_for(order.order.text);
    start(file.string());
    answer.text = file.string();
    answer.done = true;
    return;
  }
  if (file_.empty()) throw InputError({.message = "there is no record to stop"});
  if (others_) throw InputError({.message = file_ + " was begun with this run and ends with it"});
  const std::string file = file_;
  answer.done = stop();
  answer.text = file + (answer.done ? "" : " is not complete: " + recorder_->error());
}

fs::path RecordSide::file_for(const std::string& name) const {
  const fs::path file = name.empty() ? dated(instance_.facts().name) : name;
  if (file.has_parent_path() || file.extension() != ".mcap" || file.stem().empty())
    throw InputError({.message = "a record's name ends with .mcap and names no folder; records lie in " +
                                 instance_.facts().records.string()});
  const fs::path whole = instance_.facts().records / file;
  if (fs::symlink_status(whole).type() != fs::file_type::not_found)
    throw InputError({.message = whole.string() + " is there already"});
  return whole;
}

void RecordSide::publish() {
  RecordStatus status;
  if (!file_.empty()) {
    status.goes_on = true;
    if (!others_) {
      status.failed = !recorder_->error().empty();
      status.rows = recorder_->rows();
      status.bytes = recorder_->file_bytes();
      status.dropped = recorder_->dropped();
    }
    const std::size_t length = std::min(file_.size(), status.file.size() - 1);
    std::copy_n(file_.begin(), length, status.file.begin());
  }
  status_.publish(status);
}

}  // namespace kadans
