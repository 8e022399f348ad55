// `kadans view` and `kadans render`: a record in the page, for a person, and as pictures.
#pragma once

#include <optional>
#include <string>

#include "live/live_service.h"

namespace kadans {

struct ViewOptions {
  std::string record;
  LivePlace live;
};
void add_view(CLI::App& app, ViewOptions& options);
// Serves it until SIGINT or SIGTERM.
int run_view(const ViewOptions& options);

struct RenderOptions {
  std::string record;
  std::optional<double> at_s, every_s;
  bool film = false;
  int frames_per_s = 20;
  std::string out;  // file, or with every_s folder; "": beside the name of the record, here
  std::string theme = "light", size = "960x720";
};
void add_render(CLI::App& app, RenderOptions& options);
int run_render(const RenderOptions& options);

}  // namespace kadans
