// Where the taps of a transposed convolution lead, by phase of the stride: behind conv_rows.glsl.
//
// A row and column of the grid is a block of SH x SW pixels of the result, one of each phase (y mod SH, x mod SW). Tap
// (ky,kx) of input pixel (r,c) lands on pixel (r SH - PH + ky, c SW - PW + kx), so each pixel meets the taps of its phase
// only, and no lane multiplies by a structural zero.
#ifndef STRANDLIGHT_NN_TRANSPOSE_PHASES_GLSL
#define STRANDLIGHT_NN_TRANSPOSE_PHASES_GLSL

// Input rows and columns that reach a block, before and behind its own. The host keeps the padding below the kernel.
const uint UP = (KH - 1 - PH) / SH;
const uint DOWN = (PH + SH - 1) / SH;
const uint LEFT = (KW - 1 - PW) / SW;
const uint RIGHT = (PW + SW - 1) / SW;

// The phase on which a tap lands, and which row or column of the window it comes from, for the block that begins UP rows
// and LEFT columns into the window.
uint phaseOfTapY(uint ky) { return (ky + (SH - 1) * PH) % SH; }
uint phaseOfTapX(uint kx) { return (kx + (SW - 1) * PW) % SW; }
uint rowOfTap(uint ky) { return (phaseOfTapY(ky) + PH + UP * SH - ky) / SH; }
uint columnOfTap(uint kx) { return (phaseOfTapX(kx) + PW + LEFT * SW - kx) / SW; }

#endif
