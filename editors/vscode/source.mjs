// Starts `eomgen lsp` when a TOML file is there that says it is a model, and leaves all other TOML alone.

import { LanguageClient, TransportKind } from "vscode-languageclient/node";
import * as vscode from "vscode";

let client = null;

const isModel = document => document.languageId === "toml" && /^\s*eomgen\s*=/m.test(document.getText());

async function begun(document) {
    if (client || !isModel(document)) return;
    const [command, ...words] = vscode.workspace.getConfiguration("eomgen").get("command");
    const server = { command, args: [...words, "lsp"], transport: TransportKind.stdio };
    client = new LanguageClient("eomgen", "eomgen", server, { documentSelector: [{ language: "toml" }] });
    try {
        await client.start();
    } catch (error) {
        client = null;
        vscode.window.showErrorMessage(`eomgen lsp does not start: ${error.message}. pip install 'eomgen[lsp]', and see the setting eomgen.command.`);
    }
}

export function activate(context) {
    vscode.workspace.textDocuments.forEach(begun);
    context.subscriptions.push(
        vscode.workspace.onDidOpenTextDocument(begun),
        vscode.workspace.onDidChangeTextDocument(event => begun(event.document)),
    );
}

export const deactivate = () => client?.stop();
