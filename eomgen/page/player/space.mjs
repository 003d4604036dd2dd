// Scene, frame -> a picture in space.

export class SpaceView {
    constructor(root, scene) { this.root = root; this.scene = scene; }
    fit() {}
    resized() {}
    update() {}
    trailed() {}
}
