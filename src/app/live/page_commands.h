// `kadans view` shows a record in the web page; `kadans render` makes pictures of it.
#pragma once

#include <optional>
#include <string>

#include "live_service.h"

namespace kadans {

struct ViewOptions {
  std::string record;
  LiveServiceOptions live;
};
void add_view(CLI::App& app, ViewOptions& options);
// Serves the record until SIGINT or SIGTERM.
int run_view(const ViewOptions& options);

struct RenderOptions {
  std::string record;
  std::optional<double> at_s, every_s;
  bool film = false;
  int frames_per_s = 20;
  std::string out;  // file, or a folder with every_s; "": named as the record, in the working directory
  std::string theme = "light", size = "960x720";
};
void add_render(CLI::App& app, RenderOptions& options);
int run_render(const RenderOptions& options);

}  // namespace kadans
