vs_1_1
; The footprint of a voxel with a kernel of its own: voxel_grid.vs with the 3x3 variance V in object space from the vertex
; (Zwicker 2002, Eq. 31 to 33). Inputs and constants: programs.h; the mathematics: README.md.

; t in camera space, x and y times eta
dp4 r0.x, v0, c0
dp4 r0.y, v0, c1
dp4 r0.z, v0, c2

; r1 = (a, b, 1), with a and b the centre on the screen; r2 = (a^2, b^2, a b, 1)
rcp r1.w, r0.z
mul r1.xyz, r0, r1.w
mul r2, r1.xyxz, r1.xyyz

; z times the rows of J W that end on the screen, in object space: e = (row 0) - a (row 2), f = (row 1) - b (row 2)
mul r6.xyz, c2, -r1.x
add r6.xyz, r6, c0
mul r7.xyz, c2, -r1.y
add r7.xyz, r7, c1

; V e and V f
dp3 r8.x, v3, r6
dp3 r8.y, v4, r6
dp3 r8.z, v5, r6
dp3 r9.x, v3, r7
dp3 r9.y, v4, r7
dp3 r9.z, v5, r7

; z^2 (V' + I) as (11, 22, 12)
mul r1.w, r0.z, r0.z
dp3 r3.x, r6, r8
dp3 r3.y, r7, r9
dp3 r3.z, r7, r8
add r3.xy, r3, r1.w

; L with L L^T of that
rsq r4.x, r3.x
mul r5.xy, r3.xzzz, r4.x
mad r4.z, -r5.y, r5.y, r3.y
rsq r4.y, r4.z
mul r5.z, r4.z, r4.y

; the corner, x and y times eta: t + L r y
mul r6.xy, v1, c6.y
mad r0.xy, r5, r6.x, r0
mad r0.y, r5.z, r6.y, r0.y

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
