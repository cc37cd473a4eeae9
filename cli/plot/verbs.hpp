#pragma once

#include <CLI/CLI.hpp>
#include <functional>
#include <vector>

#include "cli/plot/command.hpp"

namespace vestige::plot {

/// A kind of figure: its flags, and what draws it.
struct Verb {
  const CLI::App* command;
  std::function<int(const Options&)> draw;
};

/// Adds the verbs, which fill `options`, in the order of the help.
std::vector<Verb> add_verbs(CLI::App& app, Options& options);

}  // namespace vestige::plot
