// How the page of benchmarks looks on top of the report's style.
#include "samples/strandlight/bench_page.hpp"

namespace strandlight::cli {

// Series: the palette of Okabe and Ito. Color Universal Design. 2008; lighter on dark ground.
const char* const kBenchPageStyle = R"css(
:root { --s0: #0072b2; --s1: #d55e00; --s2: #008f68; --s3: #b0528a; --s4: #c98a00; --s5: #4f9fd0; --s6: #6f6f6f; --s7: #7a4a12; --grid: #e7e7e4; }
@media (prefers-color-scheme: dark) {
  :root { --s0: #5db4ea; --s1: #ff8a3d; --s2: #2cc79a; --s3: #e592c1; --s4: #f0c24b; --s5: #9bd3f7; --s6: #a6a6a6; --s7: #c9955a; --grid: #2a2c2f; }
}
.s0 { --c: var(--s0); } .s1 { --c: var(--s1); } .s2 { --c: var(--s2); } .s3 { --c: var(--s3); }
.s4 { --c: var(--s4); } .s5 { --c: var(--s5); } .s6 { --c: var(--s6); } .s7 { --c: var(--s7); }
nav { display: flex; gap: 1.25rem; margin-top: 1rem; }
a { color: var(--accent); text-underline-offset: .2em; }
h2 { font-size: 1.4rem; font-weight: 650; letter-spacing: -0.01em; margin: 3.5rem 0 1.2rem; padding-top: 1.2rem; border-top: 2px solid var(--ink); }
h3 { font-size: 1.05rem; font-weight: 650; margin: 0 0 .2rem; }
.findings { margin-bottom: 2.5rem; } .findings td { text-align: right; font-variant-numeric: tabular-nums; }
.findings tr:last-child > * { border-bottom: 1px solid var(--line); }
.charts { display: grid; grid-template-columns: repeat(auto-fit, minmax(min(100%, 27rem), 1fr)); gap: 2.75rem 2.5rem; margin: 2rem 0 3rem; }
.chart { display: flex; flex-direction: column; min-width: 0; }
.chart > p { font-size: .875rem; margin-bottom: .7rem; } .chart > .soft { min-height: 2.6em; }
.legend { display: flex; flex-wrap: wrap; gap: .1rem 1rem; line-height: 1.5; }
.legend svg { width: .875rem; height: .875rem; vertical-align: -.12em; margin-right: .35rem; fill: var(--c); }
.legend svg.wide { width: 1.6rem; }
.plot { width: 100%; height: auto; margin-top: auto; overflow: visible; font: 12px var(--sans); }
.plot .grid line { stroke: var(--grid); } .plot .ticks text { fill: var(--soft); font-variant-numeric: tabular-nums; }
.plot .labels text { fill: var(--ink); font-size: 12.5px; }
.plot .mark { fill: var(--c); stroke: var(--ground); stroke-width: 1.2; cursor: default; }
.plot .mark:hover { stroke: var(--ink); stroke-width: 2; }
.plot .line { fill: none; stroke: var(--c); stroke-width: 1.8; stroke-linejoin: round; opacity: .75; }
.front { fill: none; stroke: var(--ink); stroke-width: 1.3; stroke-dasharray: 5 4; opacity: .6; }
.pictures { margin: 0 0 2.5rem; } .pictures .swipe { max-width: 44rem; margin: 0; }
.pictures .triptych { max-width: 44rem; margin: 1rem 0 0; } .pictures img { image-rendering: auto; }
.wide-table { overflow-x: auto; margin: 2.2rem 0; } .wide-table th.n { text-align: right; padding-right: 0; padding-left: 1rem; }
.wide-table thead th { color: var(--soft); font-size: .8125rem; vertical-align: bottom; } .wide-table td { white-space: nowrap; }
.wide-table tbody th { color: var(--ink); min-width: 15rem; } caption small { font-weight: 400; font-size: .875rem; margin-left: .5rem; }
#hint { position: fixed; z-index: 2; max-width: 22rem; padding: .5rem .7rem; font: .8125rem/1.45 var(--sans); white-space: pre-line;
  background: var(--ink); color: var(--ground); border-radius: 4px; pointer-events: none; font-variant-numeric: tabular-nums; }
)css";

// Marks say at once what the browser's own hint says after a second.
const char* const kBenchPageScript = R"js(
const hint = document.getElementById('hint');
for (const mark of document.querySelectorAll('.plot .mark')) {
  const title = mark.querySelector('title');
  const text = title.textContent;
  title.remove();
  mark.setAttribute('aria-label', text);
  mark.addEventListener('pointerenter', () => { hint.textContent = text; hint.hidden = false; });
  mark.addEventListener('pointerleave', () => { hint.hidden = true; });
  mark.addEventListener('pointermove', (event) => {
    const left = event.clientX + 14 + hint.offsetWidth > innerWidth ? event.clientX - 14 - hint.offsetWidth : event.clientX + 14;
    const top = Math.min(event.clientY + 14, innerHeight - hint.offsetHeight - 8);
    hint.style.left = Math.max(left, 4) + 'px';
    hint.style.top = Math.max(top, 4) + 'px';
  });
}
)js";

} // namespace strandlight::cli
