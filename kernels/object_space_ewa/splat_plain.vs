vs_1_1
; Second pass without EWA filtering: the reconstruction filter alone, V_r = sigma^2 I. Inputs and constants:
; programs.h.

; Eq. 14: y = 2 sqrt(2c) (v - 1/2); Eq. 12 with Lambda = sigma I: u = sigma y
mad r0.xy, v3, c5.x, c5.y
mul r0.xy, r0, v4.x

; 1/(2 pi r0 r1) with r0 = r1 = sigma, begun here: the nine dot products hide the latency of RCP
mul r4.w, v4.x, v4.x
rcp r4.w, r4.w

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

; s_k / (2 pi sigma^2)
mul r4.w, r4.w, v4.y
mul oD0.w, r4.w, c6.w
mov oD0.xyz, v5
mov oT0.xy, v3

; p_c = o + u0 s + u1 t
mad r1.xyz, r0.x, r2, r1
mad r1.xyz, r0.y, r3, r1

; frustum: (x, y, A z + B, z)
mul oPos.xyw, r1.xyzz, c3
mad oPos.z, r1.z, c4.x, c4.y
