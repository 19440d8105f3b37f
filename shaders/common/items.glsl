// The index of this invocation over one- or two-dimensional dispatches (gpu::dispatch).
layout(local_size_x = GROUP_SIZE) in;
uint item_index() {
    return (gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x) * uint(GROUP_SIZE) + gl_LocalInvocationID.x;
}
