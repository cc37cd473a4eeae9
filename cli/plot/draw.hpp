#pragma once

#include "cli/plot/command.hpp"

namespace vestige::plot {

// One function for each kind of figure. It reads the files that `options` names, draws the figure, and writes SVG and
// PNG. It returns the exit code and throws `Error`.
int draw_accuracy(const Options& options);
int draw_sweep(const Options& options);
int draw_stages(const Options& options);
int draw_skipping(const Options& options);
int draw_latency(const Options& options);
int draw_growth(const Options& options);
int draw_stress(const Options& options);
int draw_timeline(const Options& options);
int draw_textures(const Options& options);
int draw_avatar(Options options);
int draw_body(Options options);
int draw_scene(Options options);

/// Draws the page and the figures of the results of 'vestige batch'.
int draw_report(const Options& options);

/// Draws a trace as an animated picture. Writes one WebP file.
int draw_film(const Options& options);

/// Writes a trace as a time series for ParaView: a list and a folder of files instead of a figure.
int draw_paraview(const Options& options);

}  // namespace vestige::plot
