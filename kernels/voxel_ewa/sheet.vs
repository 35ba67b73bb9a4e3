vs_1_1
; A rectangle of the window: where it lies in clip coordinates, and in a surface of the frame's size; a colour.
mov oPos, v0
mov oT0.xy, v1
mov oD0, c0
