vs_1_1
; The footprint of a voxel whose kernel has the same variance V as all others of its draw (Zwicker 2002, Eq. 31 to 33):
; Cholesky factor of V' + I on the screen, as a quad that faces the eye. Inputs and constants: programs.h; the
; mathematics: README.md.

; t in camera space, x and y times eta
dp4 r0.x, v0, c0
dp4 r0.y, v0, c1
dp4 r0.z, v0, c2

; r1 = (a, b, 1, z^2), with a and b the centre on the screen; r2 = (a^2, b^2, a b, 1)
rcp r1.w, r0.z
mul r1.xyz, r0, r1.w
mul r2, r1.xyxz, r1.xyyz

; z^2 (V' + I) as (11, 22, 12), times r^2
mul r1.w, r0.z, r0.z
dp4 r3.x, r1, c3
dp4 r3.y, r1, c4
dp4 r3.z, r1, c5
mad r3.xyz, r2, c6.x, r3

; L with L L^T of that
rsq r4.x, r3.x
mul r5.xy, r3.xzzz, r4.x
mad r4.z, -r5.y, r5.y, r3.y
rsq r4.y, r4.z
mul r5.z, r4.z, r4.y

; the corner, x and y times eta: t + L y
mad r0.xy, r5, v1.x, r0
mad r0.y, r5.z, v1.y, r0.y

; frustum
mul oPos.xyw, r0.xyzz, c7
mad oPos.z, r0.z, c8.x, c8.y

; the peak 1/(|J^-1| |W^-1|) 1/(2 pi sqrt |V' + I|) over the largest: |t|/z and the pivots
dp4 r2.w, r2, c9
rsq r2.x, r2.w
mul r2.w, r2.w, r2.x
mul r2.x, r4.x, r4.y
mul r2.w, r2.w, r2.x

; opacity, colour, texture coordinates
mul oD0.w, v2.w, r2.w
mov oD0.xyz, v2
mad oT0.xy, v1, c8.z, c8.z
