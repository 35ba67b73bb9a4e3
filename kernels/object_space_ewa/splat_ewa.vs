vs_1_1
; Second pass: the object-space EWA filter (Ren 2002, section 5.2 and Appendix A) as a parallelogram in the surfel's
; tangent plane. u is in units of h, so V_r = sigma^2 I. Inputs and constants: programs.h; why the formulas differ
; from the printed ones where they do: README.md.

; Eq. 14, over sqrt 2: y = 2 sqrt(c) (v - 1/2)
mad r0.xy, v3, c8.x, c8.y

; Eq. 9: o, s and t in camera space
dp4 r1.x, v0, c0
dp4 r1.y, v0, c1
dp4 r1.z, v0, c2
dp3 r2.x, v1, c0
dp3 r2.y, v1, c1
dp3 r2.z, v1, c2
dp3 r3.x, v2, c0
dp3 r3.y, v2, c1
dp3 r3.z, v2, c2

; Jacobian, a column each: J_s = eta/oz^2 (s oz - o sz), J_t likewise, second row negated; z is 0, so DP3 serves
max r1.w, r1.z, c3.z            ; a surfel behind the near plane keeps a finite J
rcp r2.w, r1.w
mul r2.w, r2.w, r2.w            ; 1/oz^2
mul r4.xyz, r2.w, c6            ; (eta, -eta, 0)/oz^2
mul r5.xyz, r1, r2.z
mad r5.xyz, r2, r1.z, -r5
mul r5.xyz, r5, r4              ; J_s
mul r6.xyz, r1, r3.z
mad r6.xyz, r3, r1.z, -r6
mul r6.xyz, r6, r4              ; J_t

; D = |J|, and J^-1 J^-T = [T -R; -R S] / D^2 with S = J_s.J_s, T = J_t.J_t, R = J_s.J_t
mul r7.x, r5.x, r6.y
mad r7.x, -r5.y, r6.x, r7.x     ; D
mul r7.x, r7.x, r7.x            ; D^2
dp3 r8.x, r6, r6                ; T
dp3 r8.y, r5, r5                ; S
dp3 r8.z, r5, r6                ; R
add r8.w, r8.x, r8.y            ; S + T
mad r8.w, r8.w, r8.w, c7.x
mad r7.x, r8.w, c7.y, r7.x      ; D^2 + 1e-11 ((S + T)^2 + 1e-16): an edge-on surfel keeps a finite M
rcp r7.x, r7.x                  ; 1/D^2

; M = V_r + J^-1 J^-T = [A B/2; B/2 C], by halves of p = A - C, q = A + C (Appendix A): V_r is isotropic, no part of p
mul r8.xyz, r8, r7.x            ; T/D^2, S/D^2, R/D^2 = -B/2
mul r8.xy, r8, c4.w
add r8.w, r8.x, r8.y            ; half the trace of J^-1 J^-T
mul r7.y, v4.x, v4.x            ; sigma^2
add r9.xy, r8, -r8.yxzw         ; p/2, -p/2
add r10.y, r8.w, r7.y           ; q/2

; |t|/2 = sqrt((p/2)^2 + (B/2)^2)
sge r9.zw, r9.xxxy, c9          ; p >= 0, p < 0
max r9.x, r9.x, r9.y
max r9.x, r9.x, c7.w            ; |p|/2, never 0: M = I gives the identity, and p = 0 with B < 0 its own sign
mul r7.z, r8.z, r8.z
mad r7.z, r9.x, r9.x, r7.z
rsq r8.y, r7.z                  ; 2/|t|
mul r7.z, r7.z, r8.y            ; |t|/2

; larger eigenvalue (q + |t|)/2; the smaller by |M| = sigma^4 + sigma^2 trace(J^-1 J^-T) + 1/D^2: q - |t| cancels
add r7.z, r10.y, r7.z           ; r0^2
add r10.z, r10.y, r8.w
mad r10.z, r10.z, r7.y, r7.x    ; |M|
rsq r8.x, r10.z                 ; 1/(r0 r1)
rcp r7.y, r8.x
rsq r7.w, r7.z                  ; 1/r0
mul r10.xy, r7.zyxw, r7.w       ; r0, r1

; Seen edge-on a parallelogram reaches past the eye: y becomes so short that no corner comes nearer than half the depth,
; as r0 sqrt(2) sqrt(2c) |(sz, tz)| is the most that one can. The texture follows: the Gaussian is cut, not squeezed.
mul r4.x, r2.z, r2.z
mad r4.x, r3.z, r3.z, r4.x
mul r4.x, r4.x, r7.z
rsq r4.x, r4.x
mul r4.x, r4.x, r1.w
mul r4.x, r4.x, c7.z
min r4.x, r4.x, c3.w
mul r0.xy, r0, r4.x

; larger component of the eigenvector, times sqrt 2: sqrt(1 + |p|/|t|), the other B/|t| over it: t - p cancels, and the
; sign comes out right
mad r11.x, r9.x, r8.y, c3.w
rsq r11.z, r11.x
mul r11.x, r11.x, r11.z
mul r10.z, -r8.z, r8.y
mul r10.z, r10.z, r11.z

; theta within 45 degrees (Appendix A), so that each corner keeps to its own weight: where p < 0 the larger axis is the
; second one, and the other component changes its sign
mul r7, r10.xxzz, r9.zwzw
max r11.zw, r7.xxxy, r10.y      ; the radius along each axis
add r11.y, r7.z, -r7.w          ; sqrt 2 sin(theta); r11.x is sqrt 2 cos(theta)

; Eq. 12: u = Rot(theta) Lambda y
mul r4.xy, r0, r11.zwzw
mul r5.xy, r11, r4.x
mad r5.x, -r11.y, r4.y, r5.x
mad r5.y, r11.x, r4.y, r5.y

; p_c = o + u0 s + u1 t
mad r1.xyz, r5.x, r2, r1
mad r1.xyz, r5.y, r3, r1

; frustum: (x, y, A z + B, z)
mul oPos.xyw, r1.xyzz, c3
mad oPos.z, r1.z, c4.x, c4.y

; s_k / (2 pi r0 r1)
mul r8.x, r8.x, v4.y
mul oD0.w, r8.x, c6.w
mov oD0.xyz, v5
mad oT0.xy, r0, c8.z, c8.w
