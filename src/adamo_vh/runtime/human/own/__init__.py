"""Own characters: a rigged humanoid from a file becomes a `Figure` like the built-in ones.

The design, in the order in which a file goes through it.

1. **The body stays.** Eyes' height, reach, radius and every motion are those of the built-in body,
   since they are scored. Only the looks change: the mesh is *fitted* to the standard skeleton in
   its rest pose, once, when the file is read. From there on nothing knows that it came from a
   file: MuJoCo, films, the studio's page and the export take a `Figure` as ever, and gait, gaze and
   reach are the same code. A hand that takes a cup is where the standard hand is.
2. `container`, `fields`, `numbers`: a GLB (a VRM is one) is untrusted. Its JSON is validated by
   typed models, every number of an array is bounded before memory is taken for it, nothing is
   fetched, and every fault is a `Broken`, which `reading` turns into one line with the file's name.
3. `tree`: nodes to world matrices; a node with two parents or in a cycle is refused.
4. `bones`, `names`: which node is which bone, by VRM's own map (1.0 and 0.x), else by name (Mixamo,
   Unity, Unreal, Rigify, Biped, VRoid and ours). The trunk is found by its place in the tree, as
   nobody agrees on its names.
5. `stature`: the bones say which way is up, left and forward, and how large it is; so neither axes
   nor units of the file matter.
6. `fitting`: one affine map for each standard joint. Trunk and head are scaled and moved and never
   turned; arms and legs are turned so that their bones lie along ours (from a T, an A, or anything
   between), and stretched to their lengths; the hand is turned about its axis until the palm faces
   as ours does; soles end up on the floor. A vertex goes where its weights' maps take it, and the
   weights of a bone that is not ours (twist, hair, skirt, toys) are those of the nearest one above.
7. `skins`, `surfaces`, `cutting`: meshes of one material become one garment, apart for the head,
   which eyes do not see. What is transparent is cut out of the mesh along its outline, as the
   engine draws nothing half; two-sided faces get a back.
8. `expressions`: morph targets under ARKit's names, from such names, from VRM's expressions, or
   from the usual visemes.
9. `conformance`: what was found, what was not and what that means, and the licence as it says.
"""
