using System;
using System.Collections.Generic;
using System.IO;
using System.Net.WebSockets;
using System.Text;
using System.Threading;
using System.Threading.Tasks;

namespace Adamo
{
    /// <summary>Dials in to ADAMO, and answers its requests with an engine.</summary>
    /// <remarks>
    /// Every request is carried out where RunAsync was called: in Unity call it from the main thread
    /// (Start of a MonoBehaviour), and the engine may use the whole Unity API.
    /// </remarks>
    public sealed class EngineClient
    {
        const int MostBytes = 8000000;
        readonly IAdamoEngine engine;
        readonly Hello hello;

        public EngineClient(IAdamoEngine engine, string name, Abilities abilities)
        {
            this.engine = engine;
            hello = new Hello { Wire = Wire.Version, Engine = name, Frame = Frame.Name, Abilities = abilities };
        }

        /// <summary>Dial in, and answer until the other side hangs up.</summary>
        /// <param name="url">Where ADAMO waits: ws://HOST:PORT/engine.</param>
        /// <param name="token">What the server asks for; empty for none.</param>
        /// <param name="cancel">Ends it.</param>
        public async Task RunAsync(Uri url, string token, CancellationToken cancel)
        {
            using (var socket = new ClientWebSocket())
            {
                if (!string.IsNullOrEmpty(token))
                    socket.Options.SetRequestHeader("Authorization", "Bearer " + token);
                await socket.ConnectAsync(url, cancel);
                await SendText(socket, Call("hello", hello.Write()), cancel);
                string message;
                while ((message = await ReceiveText(socket, cancel)) != null)
                {
                    var pictures = new List<byte[]>();
                    await SendText(socket, Answer(message, pictures), cancel);
                    foreach (byte[] picture in pictures)
                        await socket.SendAsync(new ArraySegment<byte>(picture), WebSocketMessageType.Binary, true, cancel);
                }
            }
        }

        /// <summary>The answer to a request; its pictures follow as messages of their own.</summary>
        public string Answer(string message, List<byte[]> pictures)
        {
            object id = null;
            var answer = new Dictionary<string, object> { { "jsonrpc", "2.0" } };
            try
            {
                var request = Json.Map(Json.Parse(message));
                request.TryGetValue("id", out id);
                object wish;
                if (!request.TryGetValue("params", out wish)) wish = new Dictionary<string, object>();
                string method = request.ContainsKey("method") ? Json.Words(request["method"]) : "";
                answer["result"] = Requests.Answer(engine, method, wish, pictures);
                answer["attachments"] = pictures.Count;
            }
            catch (Exception error)
            {
                // A mistake of the engine's own must not end the program.
                pictures.Clear();
                string whose = error is AdamoException ? "" : error.GetType().Name + ": ";
                answer["error"] = new Dictionary<string, object> { { "code", 1 }, { "message", whose + error.Message } };
            }
            answer["id"] = id;
            return Json.Text(answer);
        }

        static string Call(string method, object parameters)
        {
            return Json.Text(new Dictionary<string, object> { { "jsonrpc", "2.0" }, { "method", method }, { "params", parameters } });
        }

        static Task SendText(ClientWebSocket socket, string text, CancellationToken cancel)
        {
            byte[] bytes = Encoding.UTF8.GetBytes(text);
            return socket.SendAsync(new ArraySegment<byte>(bytes), WebSocketMessageType.Text, true, cancel);
        }

        static async Task<string> ReceiveText(ClientWebSocket socket, CancellationToken cancel)
        {
            var part = new byte[65536];
            using (var whole = new MemoryStream())
            {
                while (true)
                {
                    WebSocketReceiveResult got;
                    try
                    {
                        got = await socket.ReceiveAsync(new ArraySegment<byte>(part), cancel);
                    }
                    catch (WebSocketException)
                    {
                        return null; // The other side has gone.
                    }
                    if (got.MessageType == WebSocketMessageType.Close) return null;
                    whole.Write(part, 0, got.Count);
                    if (whole.Length > MostBytes) throw new AdamoException("a message is too long.");
                    if (got.EndOfMessage) return Encoding.UTF8.GetString(whole.ToArray());
                }
            }
        }
    }
}
