#pragma once

#include <string_view>

namespace vestige::plot {

/// The report's style sheet: light and dark, print, any width from a phone's up. Figures keep a white background.
inline constexpr std::string_view kReportStyle = R"css(
:root {
  color-scheme: light dark;
  --paper: #ffffff; --ink: #1d2126; --soft: #565d66; --line: #d5dae0; --stripe: #f5f7f9; --accent: #005a91;
  --mark: #e7f1f8; --warn: #8a3b00; --warn-paper: #fdf1e7;
}
@media (prefers-color-scheme: dark) {
  :root {
    --paper: #14171a; --ink: #e6e9ec; --soft: #a3abb4; --line: #353b42; --stripe: #1b1f24; --accent: #7cc0ee;
    --mark: #14293a; --warn: #f2b27d; --warn-paper: #2c2117;
  }
}
* { box-sizing: border-box; }
html { -webkit-text-size-adjust: 100%; scroll-behavior: smooth; }
@media (prefers-reduced-motion: reduce) { html { scroll-behavior: auto; } }
body {
  margin: 0; background: var(--paper); color: var(--ink);
  font: 1rem/1.55 system-ui, "Segoe UI", "Liberation Sans", Arial, Helvetica, sans-serif;
}
header, main, nav, footer { max-width: 77rem; margin: 0 auto; padding: 0 1.25rem; }
header { padding-top: 2rem; }
.skip { position: absolute; left: -100rem; }
.skip:focus { left: 1rem; top: 1rem; background: var(--paper); padding: .5rem 1rem; z-index: 2; }
a { color: var(--accent); }
a:focus-visible, [tabindex]:focus-visible, summary:focus-visible { outline: 3px solid var(--accent); outline-offset: 2px; }
h1 { font-size: 1.9rem; line-height: 1.2; margin: 0 0 .75rem; }
h2 { font-size: 1.35rem; margin: 2.75rem 0 .6rem; padding-top: .5rem; border-top: 1px solid var(--line); }
h3 { font-size: 1.1rem; margin: 2rem 0 .4rem; overflow-wrap: anywhere; }
p, ul, ol, dl { max-width: 46rem; }
.lead { font-size: 1.15rem; margin: 0 0 .6rem; overflow-wrap: anywhere; }
.soft { color: var(--soft); font-size: .9rem; }
.caution { background: var(--warn-paper); border-left: 4px solid var(--warn); padding: .6rem 1rem; max-width: 46rem; }
.caution ul { margin: 0; padding-left: 1.1rem; }
nav ol { padding: 0; margin: 1rem 0 0; list-style: none; display: flex; flex-wrap: wrap; gap: .25rem 1.25rem; max-width: none; }
.scroll { overflow: auto; max-width: 100%; margin: .75rem 0 1.25rem; }
.tall { max-height: 38rem; }
table { border-collapse: collapse; font-size: .9rem; font-variant-numeric: tabular-nums; }
caption { text-align: left; padding: 0 0 .5rem; color: var(--soft); }
caption span { display: block; width: fit-content; max-width: min(46rem, calc(100vw - 3rem)); position: sticky; left: 0; }
th, td { padding: .35rem .8rem; text-align: left; vertical-align: top; border-bottom: 1px solid var(--line); }
thead th { position: sticky; top: 0; background: var(--paper); border-bottom: 2px solid var(--line); vertical-align: bottom; }
.n { text-align: right; white-space: nowrap; }
thead .n { white-space: normal; }
.interval { color: var(--soft); white-space: nowrap; }
.name { overflow-wrap: anywhere; min-width: 6rem; max-width: 18rem; }
tr.level td, tr.level th { background: var(--mark); }
.all tbody th { position: sticky; left: 0; background: var(--paper); }
.all thead th { min-width: 6.5rem; }
.all thead th:first-child { left: 0; z-index: 1; }
.formula { min-width: 18rem; max-width: 30rem; }
.source { min-width: 12rem; max-width: 22rem; }
.model { display: inline-block; font-size: .78rem; line-height: 1.3; padding: .1rem .45rem; border: 1px solid var(--warn); color: var(--warn); border-radius: .3rem; }
.figures { display: flex; flex-wrap: wrap; gap: 0 .8rem; align-items: flex-start; }
figure { margin: .75rem 0; max-width: 100%; }
.sheet { background: #fff; border: 1px solid var(--line); border-radius: .35rem; padding: .4rem; overflow-x: auto; width: fit-content; max-width: 100%; }
.sheet svg { display: block; max-width: 100%; height: auto; }
.wide svg { width: 52rem; min-width: 34rem; }
.ranking svg { width: 33rem; }
figcaption { font-size: .88rem; color: var(--soft); margin-top: .35rem; max-width: 40rem; overflow-wrap: anywhere; }
.pair { flex: 0 1 auto; }
.pair figcaption { max-width: 22rem; }
details { margin: .75rem 0; }
summary { cursor: pointer; padding: .25rem 0; }
dt { font-weight: 600; }
dd { margin: 0 0 .5rem; overflow-wrap: anywhere; }
code { font: .88em ui-monospace, "Liberation Mono", Menlo, monospace; overflow-wrap: anywhere; }
footer { padding-top: 1rem; padding-bottom: 3rem; }
@media (max-width: 34rem) {
  h1 { font-size: 1.5rem; }
  header, main, nav, footer { padding-left: 1rem; padding-right: 1rem; }
  .sheet { padding: .3rem; }
  th, td { padding: .3rem .5rem; }
}
@media print {
  :root { --paper: #fff; --ink: #000; --soft: #444; --line: #bbb; --mark: #eef4f8; --warn: #7a3300; --warn-paper: #fff; --accent: #000; }
  @page { margin: 16mm; }
  body { font-size: 9.5pt; }
  nav, .skip { display: none; }
  header, main, footer { max-width: none; padding: 0; }
  .scroll, .tall, .sheet { overflow: visible; max-height: none; }
  .sheet { border: 0; padding: 0; }
  .wide svg, .ranking svg { width: auto; min-width: 0; }
  table { font-size: 8pt; }
  th, td { padding: .15rem .4rem; }
  .formula, .source { min-width: 0; }
  .name { min-width: 3.5rem; overflow-wrap: break-word; }
  .pair { width: 32.5%; }
  .pair .sheet { width: 100%; }
  thead th, .all tbody th { position: static; }
  .all thead th { min-width: 0; }
  figure, tr { break-inside: avoid; }
  h2, h3 { break-after: avoid; }
  @page landscape { size: A4 landscape; margin: 10mm; }
  .metrics { page: landscape; }
  .all { font-size: 5pt; }
  .all th, .all td { padding: .1rem .12rem; white-space: normal; }
  .all .interval { white-space: normal; }
}
)css";

}  // namespace vestige::plot
