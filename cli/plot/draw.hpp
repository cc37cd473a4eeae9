#pragma once

#include "cli/plot/command.hpp"

namespace vestige::plot {

// One for each kind of figure: reads what `options` names, draws it, writes SVG and PNG. Each returns the exit code and
// throws `Error`.
int draw_accuracy(const Options& options);
int draw_sweep(const Options& options);
int draw_growth(const Options& options);
int draw_stress(const Options& options);
int draw_timeline(const Options& options);
int draw_textures(const Options& options);
int draw_avatar(Options options);
int draw_body(Options options);
int draw_scene(Options options);

/// The page and the figures of what 'vestige batch' wrote.
int draw_report(const Options& options);

/// A trace as a time series for ParaView: a list and a folder of files instead of a figure.
int draw_paraview(const Options& options);

}  // namespace vestige::plot
