#include "urdf_dom.h"

#include <exception>
#include <mutex>

#include <console_bridge/console.h>
#include <urdf_parser/urdf_parser.h>

namespace kadans {
namespace {

class Listener final : public console_bridge::OutputHandler {
 public:
  Listener() : level_(console_bridge::getLogLevel()), before_(console_bridge::getOutputHandler()) {
    console_bridge::setLogLevel(console_bridge::CONSOLE_BRIDGE_LOG_WARN);
    console_bridge::useOutputHandler(this);
  }
  ~Listener() override {
    console_bridge::useOutputHandler(before_);
    console_bridge::setLogLevel(level_);
  }
  Listener(const Listener&) = delete;
  Listener& operator=(const Listener&) = delete;

  void log(const std::string& text, console_bridge::LogLevel level, const char*, int) override {
    if (level >= console_bridge::CONSOLE_BRIDGE_LOG_WARN) heard.push_back(text);
  }

  std::vector<std::string> heard;

 private:
  console_bridge::LogLevel level_;
  console_bridge::OutputHandler* before_;
};

}  // namespace

UrdfDom parse_with_urdfdom(const std::string& xml) {
  static std::mutex one_at_a_time;
  const std::lock_guard lock(one_at_a_time);
  Listener listener;
  UrdfDom result;
  try {
    result.model = urdf::parseURDF(xml);
  } catch (const std::exception& error) {
    listener.heard.emplace_back(error.what());
  }
  result.complaints = std::move(listener.heard);
  if (!result.model && result.complaints.empty()) result.complaints.emplace_back("no model in this file");
  return result;
}

}  // namespace kadans
