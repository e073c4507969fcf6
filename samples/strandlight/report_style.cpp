// How the report looks, and its one moving part.
#include "samples/strandlight/report_page.hpp"

namespace strandlight::cli {

// Pictures stand on neutral grey in both schemes: a tinted surround would change how they look.
const char* const kReportStyle = R"css(
:root {
  color-scheme: light dark;
  --ground: #fbfbfa; --ink: #1d1f21; --soft: #63676c; --line: #dcddd9; --mat: #e9e9e7; --accent: #9a4f12;
  --sans: system-ui, -apple-system, "Segoe UI", Roboto, "Helvetica Neue", "DejaVu Sans", sans-serif;
  --mono: ui-monospace, "SF Mono", "Cascadia Mono", Menlo, Consolas, "DejaVu Sans Mono", monospace;
}
@media (prefers-color-scheme: dark) {
  :root { --ground: #161718; --ink: #e4e4e1; --soft: #9a9ea3; --line: #33363a; --mat: #222325; --accent: #e39a5b; }
}
* { box-sizing: border-box; }
body { margin: 0; background: var(--ground); color: var(--ink); font: 16px/1.5 var(--sans); }
main { max-width: 72rem; margin: 0 auto; padding: 2.5rem 1.5rem 4rem; }
h1 { font-size: 1.75rem; line-height: 1.2; font-weight: 650; letter-spacing: -0.01em; margin: 0 0 .35rem; overflow-wrap: anywhere; }
p { margin: 0 0 .6rem; max-width: 46rem; }
.soft { color: var(--soft); }
.note { font-size: .875rem; margin-top: .6rem; }
.facts { display: grid; grid-template-columns: repeat(auto-fit, minmax(8.5rem, 1fr)); margin: 1.8rem 0 2rem;
  border-top: 1px solid var(--line); border-bottom: 1px solid var(--line); }
.facts div { padding: .7rem 1rem .75rem 0; }
.facts dt { color: var(--soft); font-size: .8125rem; }
.facts dd { margin: 0; font-size: 1.4rem; font-variant-numeric: tabular-nums; letter-spacing: -0.01em; }
.facts small { font-size: .8125rem; color: var(--soft); letter-spacing: 0; }
figure { margin: 0; }
figcaption { color: var(--soft); font-size: .875rem; margin-top: .4rem; }
img { display: block; width: 100%; height: auto; }
.swipe { position: relative; background: var(--mat); overflow: hidden; --at: 50%; max-width: 60rem; margin: 0 auto; }
.swipe .over { position: absolute; inset: 0; clip-path: inset(0 calc(100% - var(--at)) 0 0); }
.swipe .rule { position: absolute; top: 0; bottom: 0; left: var(--at); width: 2px; margin-left: -1px; background: #fff;
  box-shadow: 0 0 0 1px rgb(0 0 0 / .45); pointer-events: none; }
.swipe .rule::after { content: ""; position: absolute; top: 50%; left: 50%; width: 1.5rem; height: 1.5rem;
  transform: translate(-50%, -50%); border-radius: 50%; background: #fff; box-shadow: 0 0 0 1px rgb(0 0 0 / .45); }
.swipe span { position: absolute; bottom: .6rem; padding: .1rem .5rem; font-size: .8125rem; color: #fff; background: rgb(0 0 0 / .6);
  pointer-events: none; }
.swipe .left { left: .6rem; } .swipe .right { right: .6rem; }
.swipe input { position: absolute; inset: 0; width: 100%; height: 100%; margin: 0; opacity: 0; cursor: ew-resize; touch-action: pan-y; }
.swipe:focus-within { outline: 2px solid var(--accent); outline-offset: 2px; }
.triptych { display: grid; grid-template-columns: repeat(3, minmax(0, 1fr)); gap: 1rem; margin: 1.5rem 0 2.5rem; }
.scale { display: flex; align-items: center; gap: .5rem; font-variant-numeric: tabular-nums; }
.scale img { height: .6rem; width: auto; flex: 1; min-width: 0; }
.columns { display: grid; grid-template-columns: repeat(2, minmax(0, 1fr)); gap: 2.5rem 3rem; }
table { border-collapse: collapse; width: 100%; font-size: .9375rem; }
caption { text-align: left; font-weight: 650; font-size: 1.05rem; padding-bottom: .5rem; }
th, td { text-align: left; font-weight: 400; padding: .3rem 1rem .3rem 0; border-top: 1px solid var(--line); vertical-align: baseline; }
th { color: var(--soft); }
td.n { text-align: right; font-variant-numeric: tabular-nums; padding-right: 0; white-space: nowrap; }
td.n + td.n { padding-left: 1rem; }
td.bar { width: 34%; padding: 0 0 0 1rem; vertical-align: middle; }
td.bar i { display: block; height: .55rem; min-width: 1px; background: var(--accent); }
code { font: .875em var(--mono); overflow-wrap: anywhere; }
@media (max-width: 46rem) { .triptych, .columns { grid-template-columns: minmax(0, 1fr); } main { padding: 1.5rem 1rem 3rem; } }
@media print { .swipe { display: none; } body { background: #fff; } }
)css";

const char* const kReportScript = R"js(
for (const swipe of document.querySelectorAll('.swipe')) {
  const range = swipe.querySelector('input');
  const move = () => swipe.style.setProperty('--at', range.value + '%');
  range.addEventListener('input', move);
  move();
}
)js";

} // namespace strandlight::cli
